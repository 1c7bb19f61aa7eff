// The sequences of matrices that the strategies are compared on, each on one pattern.
#include "sequences.hpp"

#include <cmath>
#include <functional>
#include <utility>

#include "mechanism.hpp"

namespace mbs::stale_pivots {
namespace {

constexpr int kMatrices = 91;

/// What a sequence has at matrix k.
using Motion = std::function<Instant(int k)>;

/// From 1.5 rad to 1.5e-9 rad.
Motion upright(double penalty) {
  return [=](int k) {
    Instant instant;
    instant.angle = 1.5 * std::pow(10.0, -k / 10.0);
    instant.penalty = penalty;
    return instant;
  };
}

/// From 1.5 rad to 0.15 rad, at even speed.
Instant falling(int k, double penalty) {
  Instant instant;
  instant.angle = 1.5 - 0.015 * k;
  instant.penalty = penalty;
  return instant;
}

Motion masses_swap(double penalty) {
  return [=](int k) {
    Instant instant = falling(k, penalty);
    for (int i = 0; i <= kLoops; ++i) instant.rod_mass[i] = (i + k) % 2 == 0 ? 1e-6 : 1e6;
    instant.coupler_mass = 1e-6;
    return instant;
  };
}

Motion contacts(double penalty) {
  return [=](int k) {
    Instant instant = falling(k, penalty);
    for (int i = 0; i <= kLoops; ++i) instant.contact[i] = (7 * i + 3 * k) % 5 == 0 ? 1e14 : 1e4;
    return instant;
  };
}

/// From 1e6 N/m, which adds 0.8 kg, to 1e11 N/m.
Motion multipliers_swap(double penalty) {
  return [=](int k) {
    Instant instant = falling(k, penalty);
    const double size = 1e6 * std::pow(10.0, k / 18.0);
    for (int i = 0; i < kConstraints; ++i) {
      instant.lambda.push_back((7 * i + 3 * k) % 5 < 2 ? size : -size);
    }
    return instant;
  };
}

Sequence penalty_form(const char* name, const Motion& motion) {
  Sequence sequence(name, "penalty");
  if (!motion(0).lambda.empty()) sequence.kind = Structure::Kind::indefinite;
  for (int k = 0; k < kMatrices; ++k) {
    Matrix matrix = tangent_matrix(motion(k));
    sequence.pattern = std::move(matrix.pattern);
    sequence.order = std::move(matrix.order);
    sequence.matrices.push_back(std::move(matrix.values));
  }
  return sequence;
}

/// Where the scales of multipliers come from.
enum class Scales {
  first,  ///< the first matrix
  own,    ///< each matrix
  none,
};

Sequence saddle_form(const char* name, const Motion& motion, Scales scales = Scales::first) {
  Sequence sequence(name, "saddle-point");
  sequence.kind = Structure::Kind::indefinite;
  std::vector<double> scale = scales_at(motion(0));
  if (scales == Scales::none) scale.assign(kConstraints, 1.0);
  for (int k = 0; k < kMatrices; ++k) {
    if (scales == Scales::own) scale = scales_at(motion(k));
    Matrix matrix = saddle_matrix(motion(k), scale);
    sequence.pattern = std::move(matrix.pattern);
    sequence.order = std::move(matrix.order);
    sequence.matrices.push_back(std::move(matrix.values));
  }
  return sequence;
}

Sequence ordered_by_amd(Sequence sequence) {
  sequence.order.clear();
  return sequence;
}

}  // namespace

std::vector<Sequence> all_sequences() {
  constexpr double soft = 4e9, stiff = 1e14;  // automatic in penalty and in saddle-point form
  std::vector<Sequence> all;
  all.push_back(penalty_form("upright, alpha 1e10", upright(1e10)));
  all.push_back(penalty_form("upright, alpha 1e14", upright(stiff)));
  all.push_back(saddle_form("upright, alpha 1e14", upright(stiff)));
  all.push_back(saddle_form("upright, alpha 1e16", upright(1e2 * stiff)));
  all.push_back(saddle_form("upright, alpha 1e18", upright(1e4 * stiff)));
  all.push_back(ordered_by_amd(saddle_form("upright, alpha 1e14, AMD", upright(stiff))));
  all.push_back(ordered_by_amd(saddle_form("upright, alpha 1e18, AMD", upright(1e4 * stiff))));
  all.push_back(penalty_form("masses swap", masses_swap(soft)));
  all.push_back(saddle_form("masses swap", masses_swap(stiff)));
  all.push_back(saddle_form("masses swap, rescaled", masses_swap(stiff), Scales::own));
  all.push_back(saddle_form("masses swap, unscaled", masses_swap(stiff), Scales::none));
  all.push_back(penalty_form("contacts", contacts(soft)));
  all.push_back(saddle_form("contacts", contacts(stiff)));
  all.push_back(penalty_form("multipliers swap", multipliers_swap(soft)));
  all.push_back(saddle_form("multipliers swap", multipliers_swap(stiff)));
  return all;
}

}  // namespace mbs::stale_pivots
