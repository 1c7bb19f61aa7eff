// Force elements lowered to flat arrays, and where their gradients stand.
#pragma once

#include <vector>

#include "coordinates.hpp"
#include "entries.hpp"
#include "mbs/model.hpp"

namespace mbs::csc_cholmod {

/// Springs, then force laws, all axes in one run: element axis * count + k of spring k is q[plus] -
/// q[minus]. e = +-(r_a - r_b) / L is a row's value of the same index.
struct SpringBlock {
  int dimension = 0;
  int count = 0;
  std::vector<int> plus, minus;                    ///< dimension x count
  std::vector<double> stiffness, damping, length;  ///< of springs; N/m, N s/m, m
};

/// A torsion spring or torque law. Of the two values of a row, of `dimension` components each, the
/// first is that of u.
struct TorsionElement {
  Places a, b, c, d, axis;
  double stiffness = 0.0;  ///< N m/rad
  double damping = 0.0;    ///< N m s/rad
  double angle = 0.0;      ///< rad
  int law = -1;            ///< index into LoweredForces::laws; -1: a spring
};

struct CoupleElement {
  Places a, b, axis;
  double torque = 0.0;  ///< N m
};

/// The symbolic part of all force elements. A spring's gradient g has `dimension` different values
/// up to the sign, a torsion spring's twice as many.
class LoweredForces {
 public:
  LoweredForces(const Model& model, const Coordinates& coordinates);

  /// Of `springs`, then `torsions`: what C and K consist of.
  [[nodiscard]] const SignedRows& gradients() const { return gradients_; }
  /// Of couples; values are numbered on after those of the gradients.
  [[nodiscard]] const SignedRows& couple_rows() const { return couple_rows_; }
  [[nodiscard]] int values() const {
    return gradient_values() + springs.dimension * static_cast<int>(couples.size());
  }
  /// Number of different products of two values of a gradient.
  [[nodiscard]] int products() const;
  /// Index of the product of values i and j of row `row` of gradients().
  [[nodiscard]] int product(int row, int i, int j) const;

  SpringBlock springs;
  std::vector<TorsionElement> torsions;
  std::vector<CoupleElement> couples;
  std::vector<const Law*> laws;  ///< force laws, then torque laws; the model's

 private:
  [[nodiscard]] int spring_values() const { return springs.dimension * springs.count; }
  [[nodiscard]] int spring_products() const {
    return product_count(springs.dimension) * springs.count;
  }
  [[nodiscard]] int gradient_values() const {
    return spring_values() + 2 * springs.dimension * static_cast<int>(torsions.size());
  }
  void add_springs(const Model& model, const Coordinates& coordinates);
  void add_torsions(const Model& model, const Coordinates& coordinates);
  void add_couples(const Model& model, const Coordinates& coordinates);

  SignedRows gradients_;
  SignedRows couple_rows_;
};

}  // namespace mbs::csc_cholmod
