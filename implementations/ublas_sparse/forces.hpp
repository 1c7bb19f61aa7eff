// Springs, torsion springs and couples: their forces, and their C and K.
#pragma once

#include <array>
#include <vector>

#include "matrices.hpp"
#include "mbs/model.hpp"
#include "points.hpp"

namespace mbs::ublas_sparse {

/// Eq. (11) for a fixed time step. Elements keep the gradients of the last evaluation, from which
/// S = M + (step / 2) C + (step^2 / 4) K of Eq. (5) is written.
class Forces {
 public:
  Forces(const Model& model, const Points& points, double step);

  [[nodiscard]] bool empty() const { return !has_stiffness() && couples_.empty(); }
  /// True if anything adds to C or K.
  [[nodiscard]] bool has_stiffness() const { return !springs_.empty() || !torsions_.empty(); }

  /// M with a position for everything that C and K can fill.
  [[nodiscard]] SparseMatrix storage(const Points& points, const SparseMatrix& M) const;

  /// Subtracts the share of all these in Q (n, N) at the positions and velocities of `points`.
  void subtract_force(const Points& points, Vector& rhs);
  /// Adds (step / 2) C + (step^2 / 4) K of the last evaluation, through S(i, j) += value.
  void add_stiffness(const Points& points, SparseMatrix& S) const;

 private:
  struct SpringElement {
    int a, b;  // first coordinates
    double stiffness, damping, length;
    double weight;            // step / 2 c + step^2 / 4 k
    Triple e{};               // of the last evaluation, as the next
    double transverse = 0.0;  // step^2 / 4 p
  };
  struct TorsionElement {
    std::array<int, 4> points;  // a, b, c, d
    int axis;                   // -1: planar
    double stiffness, damping, angle, weight;
    std::array<Triple, 4> gradient{};  // at these points
  };
  struct CoupleElement {
    int a, b, axis;
    double torque;
  };

  void evaluate(const Points& points, SpringElement& spring, Vector& rhs) const;
  void evaluate(const Points& points, TorsionElement& torsion, Vector& rhs) const;
  void evaluate(const Points& points, const CoupleElement& couple, Vector& rhs) const;

  double scale_;  // step^2 / 4
  std::vector<SpringElement> springs_;
  std::vector<TorsionElement> torsions_;
  std::vector<CoupleElement> couples_;
};

}  // namespace mbs::ublas_sparse
