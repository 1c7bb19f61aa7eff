// System: construction, state in and out. Part of system.hpp.
#pragma once

#include "system.hpp"

namespace mbs::compiled_ldl {

/// Or the multistep method, which begins with it and has the same matrix.
inline bool is_rattle(const StepSettings& s) {
  return s.scheme != Scheme::penalty && s.scheme != Scheme::saddle_point;
}

/// The number that the settings of each lane have.
template <typename S>
S of_settings(std::span<const StepSettings> settings, double StepSettings::*member) {
  S value = static_cast<S>(settings[0].*member);
  for (int i = 1; i < static_cast<int>(settings.size()); ++i) {
    set_lane(value, i, settings[i].*member);
  }
  return value;
}

template <typename S, typename F, int D>
System<S, F, D>::System(std::span<const Model* const> models,
                        std::span<const StepSettings> settings)
    : program(program_of(*models[0], settings[0], kLanesOf<F> == 1 ? 8 : 1)),
      rows(*models[0], program),
      saddle(has_multiplier_rows(settings[0])),
      rattle(is_rattle(settings[0])),
      curved(settings[0].geometric_stiffness),
      alpha(of_settings<S>(settings, &StepSettings::penalty)),
      h(static_cast<S>(settings[0].step * settings[0].step / 4.0)),
      constraints(models, program, rows, saddle, curved),
      drivers(models, rows, constraints),
      forces(models, program, rows, settings[0].step),
      mass(models, program, rows),
      fronts(program, !saddle && !curved) {
  epsilon = S(1.0) / (alpha * h);
  for (auto* x : {&q, &v, &a, &force, &y}) x->resize(rows.extent, S(0.0));
  for (auto* x : {&lambda, &phi, &terms}) x->resize(constraints.count(), S(0.0));
  if (!kSame) rounded_.resize(program.padded, F(0.0));
  for (std::size_t i = 0; i < rows.of_point.size(); ++i) {
    if (rows.is_free(rows.of_point[i])) continue;
    for (int x = 0; x < D; ++x) {
      q[rows.of_point[i] + x] =
          of_models<S>(models, [&](const Model& m) { return m.points()[i].position[x]; });
    }
  }
  fill_constants();
  drivers.drive(0.0, q.data(), v.data(), constraints, force.data());
}

template <typename S, typename F, int D>
void System<S, F, D>::fill_constants() {
  mass.add_to(fronts.constants());
  constraints.add_constant(fronts.constants(), h * alpha);
  if (!saddle) return;
  for (int k = 0; k < constraints.count(); ++k) {
    const int row = constraints.row(k);
    fronts.constants()[program.entry(row, row)] -= static_cast<F>(epsilon);
  }
}

template <typename S, typename F, int D>
void System<S, F, D>::put(int lane, const State& state) {
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    const int row = rows.of_coordinate[i];
    set_lane(q[row], lane, state.q[i]);
    set_lane(v[row], lane, state.v[i]);
    set_lane(a[row], lane, state.a[i]);
  }
  std::fill(y.begin(), y.end(), S(0.0));  // nothing of a failed step is left behind
  for (int k = 0; k < constraints.count(); ++k) {
    set_lane(lambda[k], lane, state.lambda[constraints.number(k)]);
  }
}

template <typename S, typename F, int D>
void System<S, F, D>::get(int l, State& state) const {
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    const int row = rows.of_coordinate[i];
    state.q[i] = lane(q[row], l);
    state.v[i] = lane(v[row], l);
    state.a[i] = lane(a[row], l);
  }
  for (int k = 0; k < constraints.count(); ++k) {
    state.lambda[constraints.number(k)] = lane(lambda[k], l);
  }
}

}  // namespace mbs::compiled_ldl
