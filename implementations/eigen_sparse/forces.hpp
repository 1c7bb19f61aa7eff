// Forces that depend on q' and v': what they add to Q, T and the right-hand sides of Eq. (15).
#pragma once

#include <memory>
#include <vector>

#include "coordinates.hpp"
#include "rank_update.hpp"

namespace mbs::eigen_sparse {

/// One kind of force elements with their share of (dt/2) C + (dt^2/4) K, which stays in the
/// elements: gradients and weights of the last apply().
class Force {
 public:
  Force() = default;
  virtual ~Force() = default;
  Force(const Force&) = delete;
  Force& operator=(const Force&) = delete;

  /// Adds the forces at `q`, `v` (extended; m, m/s) to `force` (n, N), Eq. (11).
  virtual void apply(const Vector& q, const Vector& v, Vector& force) = 0;
  /// Adds (dt/2) C + (dt^2/4) K to the values of the matrix laid out at set-up, Eq. (5).
  virtual void add_to_tangent(double* tangent) const = 0;
  /// Adds [(dt/2) C + (dt^2/4) K] x to `result` (n), Eq. (15).
  virtual void add_product(const Vector& x, Vector& result) = 0;
};

using Forces = std::vector<std::unique_ptr<Force>>;

/// What set-up of a force needs: `layout` is that of the tangent or of what takes its place, `step`
/// is dt (s).
struct ForceSetup {
  const Model& model;
  const Coordinates& coordinates;
  Layout layout;
  double step;
};

/// (dt/2) damping + (dt^2/4) stiffness: the weight of g g^T in Eqs. (5) and (15).
template <class Element>
double weight_of(const Element& element, double step) {
  return 0.5 * step * element.damping + 0.25 * step * step * element.stiffness;
}

/// Each appends what its file says, if the model has it.
void append_springs(const ForceSetup& setup, Forces& forces);
void append_torsion_springs(const ForceSetup& setup, Forces& forces);
void append_couples(const ForceSetup& setup, Forces& forces);

}  // namespace mbs::eigen_sparse
