// Mechanisms whose feet are all carried along evenly: in their frame they conserve energy.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// The frame of a model without losses that is fixed to nothing but driven points, which all move
/// at one constant velocity V: there its feet rest and, by Galilei, all forces are the same, so
/// that the energy at q - V t, v - V is conserved, while drivers do work at q, v. (A linear row of a
/// body that has a driven point has a value that is driven too: it must go along.)
class EvenCarriage {
 public:
  /// None if the model is another.
  static std::optional<EvenCarriage> of(const Model& model);

  /// Whether driven points are still where that leads at t (s); `model` is that of of().
  [[nodiscard]] bool holds(const Model& model, double t) const;
  /// V of each coordinate, n, m/s; 0 of unit vectors.
  [[nodiscard]] const std::vector<double>& velocity() const { return velocity_; }

 private:
  std::array<double, 3> carried_{};  // V, m/s
  std::vector<double> velocity_;
};

}  // namespace mbs
