// Driven points, driven values and driven mass: what is prescribed as a function of time.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mbs/model.hpp"
#include "points.hpp"

namespace mbs::csc_mumps {

/// Samples all functions once a step and adds what they give to the terms of a pass.
class Drivers {
 public:
  Drivers() = default;
  /// `values[i]` is where the value of constraint i is kept; used if the model drives values.
  Drivers(const Model& model, const ExtendedPoints& points, std::span<double* const> values);

  [[nodiscard]] bool empty() const { return points_.empty() && values_.empty(); }

  /// Takes the values at time t: driven points into q and v (extended), driven values to where the
  /// constraints keep theirs.
  void sample(double t, double* q, double* v);
  /// phi_t (m) += Phi_t at q (extended), Eqs. (7), (8).
  void add_velocity(const double* q, double* phi_t) const { add(&Rates::velocity, q, phi_t); }
  /// free_part (m) += that part of dPhi_q/dt v + dPhi_t/dt that the drivers' accelerations give.
  void add_acceleration(const double* q, double* free_part) const {
    add(&Rates::acceleration, q, free_part);
  }
  /// right (n) -= Q of the driven mass.
  void add_inertia(double* right) const;

 private:
  struct DrivenPlace {
    int offset;  // in an extended vector
    std::array<TimeFunction, 3> position;
  };
  /// A dot or bilinear constraint on at least one driven point.
  struct Product {
    std::array<int, 4> at;    // offsets in an extended vector
    std::array<int, 4> slot;  // offsets in Rates
    std::array<std::array<double, 3>, 3> B;
    int row;
  };
  struct Value {
    int row;
    double* kept;
    TimeFunction function;
  };
  struct Mass {
    int coordinate, slot;
    double value;
  };
  /// `dimension` zeros for whatever is not driven, then `dimension` numbers a driven point, then
  /// one a driven value.
  struct Rates {
    std::vector<double> velocity, acceleration;
  };

  template <class Constraint>
  void add_product(const Constraint& constraint, const std::array<std::array<double, 3>, 3>& B,
                   int row, const ExtendedPoints& points, const std::vector<int>& slot);
  void add(std::vector<double> Rates::*derivative, const double* q, double* result) const;

  int dimension_ = 0;
  std::vector<DrivenPlace> points_;
  std::vector<Product> products_;
  std::vector<Value> values_;
  std::vector<Mass> mass_;
  Rates rates_;
};

}  // namespace mbs::csc_mumps
