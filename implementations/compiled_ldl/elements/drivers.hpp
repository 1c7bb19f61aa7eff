// What is known as a function of time: points, values of constraints, the forces of driven mass.
#pragma once

#include "elements/constraints.hpp"

namespace mbs::compiled_ldl {

/// A driven point A on rows 16-17 and a rod A - B, constraint 0, of driven length, the first driven
/// value: point_rows_ = {16}, values_ = {{0, 0}}, rates_ = {ṡ}.
template <typename S, int D>
class Drivers {
 public:
  Drivers(std::span<const Model* const> models, const Rows& rows, const Constraints<S, D>& all);

  [[nodiscard]] bool any() const { return any_; }
  /// What driven points have of q, v and a, values of constraints, force = Q's constant part.
  void drive(double t, S* q, S* v, S* a, Constraints<S, D>& constraints, S* force);
  /// ṡ and s̈ of all constraints; nullptr: none is driven.
  [[nodiscard]] const S* rates() const { return values_.empty() ? nullptr : rates_.data(); }
  [[nodiscard]] const S* accelerations() const {
    return values_.empty() ? nullptr : accelerations_.data();
  }

 private:
  struct Value {
    int driven, constraint;
  };
  struct Mass {
    int row, point_row;
    S value;
  };

  std::vector<const Model*> models_;
  bool any_;
  std::vector<int> point_rows_;
  std::vector<Value> values_;
  std::vector<Mass> mass_;
  Array<S> rates_, accelerations_;  // of constraints
  Array<S> constant_;
};

template <typename S, int D>
Drivers<S, D>::Drivers(std::span<const Model* const> models, const Rows& rows,
                       const Constraints<S, D>& all)
    : models_(models.begin(), models.end()) {
  const Model& first = *models[0];
  constant_.resize(rows.extent, S(0.0));
  for (int i = 0; i < first.variables(); ++i) {
    constant_[rows.of_coordinate[i]] =
        of_models<S>(models, [&](const Model& m) { return m.force()[i]; });
  }
  any_ = !first.driven_points().empty() || !first.driven_values().empty();
  if (!any_) return;
  rates_.resize(all.count(), S(0.0));
  accelerations_.resize(all.count(), S(0.0));
  for (const DrivenPoint& point : first.driven_points()) {
    point_rows_.push_back(rows.of_point[point.point]);
  }
  for (int i = 0; i < static_cast<int>(first.driven_values().size()); ++i) {
    for (int k = 0; k < all.count(); ++k) {
      if (all.number(k) != first.driven_values()[i].constraint) continue;
      values_.push_back({i, k});
    }
  }
  for (int i = 0; i < static_cast<int>(first.driven_mass().size()); ++i) {
    const DrivenMass& mass = first.driven_mass()[i];
    mass_.push_back(
        {rows.of_coordinate[mass.coordinate], rows.of_point[mass.point] + mass.axis,
         of_models<S>(models, [&](const Model& m) { return m.driven_mass()[i].value; })});
  }
}

template <typename S, int D>
void Drivers<S, D>::drive(double t, S* q, S* v, S* a, Constraints<S, D>& constraints, S* force) {
  std::copy(constant_.begin(), constant_.end(), force);
  if (!any_) return;
  const int lanes = static_cast<int>(models_.size());
  const auto sample = [&](auto get, S& value, S& rate, S& acceleration) {
    for (int i = 0; i < lanes; ++i) {
      const TimeFunction::Sample at = get(*models_[i]).at(t);
      set_lane(value, i, at.value);
      set_lane(rate, i, at.rate);
      set_lane(acceleration, i, at.acceleration);
    }
  };
  for (std::size_t i = 0; i < point_rows_.size(); ++i) {
    for (int x = 0; x < D; ++x) {
      const int row = point_rows_[i] + x;
      const auto get = [&](const Model& m) -> const TimeFunction& {
        return m.driven_points()[i].position[x];
      };
      sample(get, q[row], v[row], a[row]);
    }
  }
  for (const Value& value : values_) {
    const auto get = [&](const Model& m) -> const TimeFunction& {
      return m.driven_values()[value.driven].value;
    };
    const int k = value.constraint;
    sample(get, constraints.value(k), rates_[k], accelerations_[k]);
  }
  for (const Mass& mass : mass_) force[mass.row] -= mass.value * a[mass.point_row];
}

// These are compiled once, beside the steps.
extern template class Drivers<double, 2>;
extern template class Drivers<double, 3>;
extern template class Drivers<float, 2>;
extern template class Drivers<float, 3>;

}  // namespace mbs::compiled_ldl
