// Phi, Phi_q and the tangent matrix: values refreshed in place on patterns made once.
#pragma once

#include <vector>

#include "coordinates.hpp"
#include "rank_update.hpp"
#include "solver.hpp"

namespace mbs::eigen_superlu {

/// Rows of Phi_q are sorted by kind: distances to the ground, distances of free points, other dot
/// constraints by number of free points, linear constraints. order()[row] is the model's index.
class Assembly {
 public:
  /// `penalty` is (dt^2/4) alpha of Eq. (5). The tangent starts as M plus what the linear
  /// constraints add, which is positive definite, with its final pattern.
  Assembly(const Model& model, const Coordinates& coordinates, Triangle triangle, double penalty);

  /// Phi and the values of Phi_q at `q` (extended, m), Eqs. (7) and (8).
  void evaluate(const Vector& q);
  /// The values of the tangent, Eq. (5), from the present Phi_q.
  void refresh_tangent();
  /// Writes (d/dt Phi_q) v to `result` (m), for `v` extended (m/s), Eqs. (7) and (8).
  void velocity_terms(const Vector& v, Vector& result) const;

  [[nodiscard]] const Vector& phi() const { return phi_; }
  [[nodiscard]] const RowSparseMatrix& jacobian() const { return jacobian_; }
  [[nodiscard]] const SparseMatrix& tangent() const { return tangent_; }
  [[nodiscard]] const std::vector<int>& order() const { return order_; }

 private:
  /// A dot constraint that is not a distance: the row of its i-th free point is
  /// weights[2i] (r_c - r_d) + weights[2i + 1] (r_a - r_b); ends are coordinates of a, b, c, d.
  struct Dot {
    int free_points = 0;
    double weights[8] = {};
    int ends[12] = {};
  };
  /// Consecutive rows of Phi_q of equal width.
  struct Run {
    AddRows add;
    int first_value, first_slot, count;
  };

  void add_distance(const Coordinates& coordinates, const DotConstraint& constraint);
  void add_dot(const Coordinates& coordinates, const DotConstraint& constraint);
  void make_jacobian(const Model& model, const Coordinates& coordinates);
  void make_runs(Triangle triangle);
  template <int kDimension>
  void evaluate_constraints(const double* q);
  template <int kDimension, int kFreeEnds>
  void evaluate_distances(const double* q, int first, int last);
  template <int kDimension>
  void evaluate_velocities(const double* v, double* result) const;

  int dimension_;
  int to_ground_ = 0;  // rows [0, to_ground_) are distances to the ground,
  int distances_ = 0;  // rows [to_ground_, distances_) those of free points,
  int quadratic_ = 0;  // rows [distances_, quadratic_) other dot constraints, then linear ones
  std::vector<int> order_;
  std::vector<int> ends_;  // of distances: coordinates of a (free), then of b
  std::vector<Dot> dots_;
  Vector value_, phi_;
  RowSparseMatrix jacobian_;

  double penalty_;
  SparseMatrix tangent_;
  Vector base_;  // values of the tangent that stay
  std::vector<int> slots_;
  std::vector<Run> runs_;
};

}  // namespace mbs::eigen_superlu
