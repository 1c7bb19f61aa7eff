// Dense storage of M, Phi and Phi_q; the residual and the tangent matrix built from them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::eigen_dense {

/// Evaluates the equations of paper/README.md for one model. With n variables and m constraints M
/// is a full n×n matrix and the Jacobian is stored transposed, n×m, a constraint a column.
///
/// Fixed points are made readable like free ones: positions and velocities are *extended* vectors,
/// the n coordinates followed by those of the fixed points (velocity 0). The Jacobian's entries for
/// fixed points go to a scratch place behind its last column.
///
/// Example, planar, A fixed at (0, 0), B free: extended q = (x_B, y_B, 0, 0).
class Assembly {
 public:
  Assembly(const Model& model, const StepSettings& settings);

  /// The model's q at t = 0, extended (m).
  [[nodiscard]] Eigen::VectorXd extended_position(const Model& model) const;

  /// Phi and Phi_q at the extended position q (m). All other methods use this Phi_q.
  void evaluate(const Eigen::VectorXd& q);

  /// Phi (m) of the last evaluate().
  [[nodiscard]] const Eigen::VectorXd& Phi() const { return Phi_; }

  /// −f of Eq. (3) into rhs (n, kg m), with a' in a (n, m/s²) and lambda (m).
  void residual(const Eigen::VectorXd& a, const Eigen::VectorXd& lambda, Eigen::VectorXd& rhs);

  /// T of Eq. (5) into the lower triangle of T (n×n, kg); the other half is scratch.
  void tangent(Eigen::MatrixXd& T) const;

  /// M v* of Eq. (6) into rhs (n), with v* extended.
  void project_velocity(const Eigen::VectorXd& v, Eigen::VectorXd& rhs) const;

  /// M a* − (Δt²/4) α Φqᵀ (Φ̇q v') of Eq. (6) into rhs (n), with the projected v' extended.
  void project_acceleration(const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                            Eigen::VectorXd& rhs);

 private:
  using Index = Eigen::Index;

  /// |r_a − r_b|² − value: where the points start in an extended vector and in the Jacobian.
  struct Distance {
    Index a, b;
    Index to_a, to_b;
    Index row;
    double value;
  };
  /// (r_a − r_b)·(r_c − r_d) − value. Each distinct free point has a slot, whose Jacobian entries
  /// are ab (r_a − r_b) + cd (r_c − r_d); a slot left over writes zeros to the scratch place.
  struct Dot {
    struct Slot {
      Index to;
      double ab, cd;
    };
    Index a, b, c, d;
    std::array<Slot, 4> slots;
    Index row;
    double value;
  };
  /// Σ coefficient q[coordinate] − value over terms [begin, end); its Jacobian is constant.
  struct Linear {
    Index begin, end;
    Index row;
    double value;
  };

  void lower_points(const Model& model);
  void lower_dot(const DotConstraint& constraint, Index row);
  void lower_linear(const LinearConstraint& constraint, Index row);
  Index jacobian_position(int point, Index row) const;
  template <int dimension>
  void evaluate_quadratic(const double* q);
  template <int dimension>
  void evaluate_velocity_term(const double* v);

  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> jacobian_transposed() const {
    return {jacobian_.data(), variables_, constraints_};
  }

  Index variables_, constraints_;
  int dimension_;
  double penalty_;
  double scale_;       ///< Δt²/4, s²
  Index slice_depth_;  ///< columns that one rank-k update takes, see tangent()

  std::vector<Index> point_start_;  ///< of each point in an extended vector
  Index extended_size_ = 0;
  std::vector<Distance> distances_;
  std::vector<Dot> dots_;
  std::vector<Linear> linears_;
  std::vector<LinearConstraint::Term> terms_;

  Eigen::MatrixXd M_;             ///< n×n, both triangles, kg
  Eigen::VectorXd scaled_force_;  ///< (Δt²/4) Q
  Eigen::VectorXd jacobian_;      ///< n×m column-major, then the scratch place
  Eigen::VectorXd Phi_;
  Eigen::VectorXd multiplier_;     ///< lambda + alpha Phi
  Eigen::VectorXd velocity_term_;  ///< Φ̇q v; zero for ever where the constraint is linear
};

}  // namespace mbs::eigen_dense
