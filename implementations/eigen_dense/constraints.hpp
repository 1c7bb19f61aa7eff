// The constraints in flat arrays: Phi, Phi_q and the quadratic part of the velocity term.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"

namespace mbs::eigen_dense {

/// Evaluates Eqs. (7) and (8). The Jacobian is stored transposed, n×m, a constraint a column; the
/// columns of the linear constraints come last and are constant. Entries for fixed points go to a
/// scratch place behind the last column. Values driven by time count as zero here, see Drivers.
template <typename Scalar>
class Constraints {
 public:
  using Vector = Eigen::VectorX<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;

  Constraints(const Model& model, const Layout& layout);

  /// Phi at the extended position q (m), with `jacobian` also Phi_q.
  void evaluate(const Vector& q, bool jacobian);

  /// 2 u̇·B ẇ of Eq. (7) into `term` (m, m²/s²), with v extended; not the rows of linear ones.
  void velocity_term(const Vector& v, Vector& term) const;

  /// y (m) += Φq x, with x of n elements or more.
  void add_product(const Vector& x, Vector& y) const;
  /// y (n) += factor Φqᵀ x, with x of m elements.
  void add_transposed_product(Scalar factor, const Vector& x, Vector& y) const;

  /// Adds factor × the share of the linear constraints in Φqᵀ Φq to both triangles of T (n×n).
  void add_linear_share(Scalar factor, Matrix& T) const;

  /// Of the last evaluate() (m).
  [[nodiscard]] const Vector& Phi() const { return Phi_; }
  [[nodiscard]] Vector& Phi() { return Phi_; }
  /// n×m, of the last evaluate() that wrote it.
  [[nodiscard]] Eigen::Map<const Matrix> jacobian_transposed() const {
    return {jacobian_.data(), variables_, Phi_.size()};
  }
  /// How many constraints are not linear: the first ones.
  [[nodiscard]] Eigen::Index quadratic() const { return quadratic_; }

 private:
  using Index = Eigen::Index;

  /// |r_a − r_b|² − value: where the points start in an extended vector and in the Jacobian.
  struct Distance {
    Index a, b;
    Index to_a, to_b;
    Index row;
    Scalar value;
  };
  /// (r_a − r_b)·(r_c − r_d) − value. Each distinct free point has a slot, whose Jacobian entries
  /// are ab (r_a − r_b) + cd (r_c − r_d); a slot left over writes zeros to the scratch place.
  struct Dot {
    struct Slot {
      Index to;
      Scalar ab, cd;
    };
    Index a, b, c, d;
    std::array<Slot, 4> slots;
    Index row;
    Scalar value;
  };
  /// The same with B: entries are ab Bᵀ (r_a − r_b) + cd B (r_c − r_d).
  struct Bilinear {
    Dot dot;
    Eigen::Matrix<Scalar, 3, 3> B;
  };
  /// Σ coefficient q[coordinate] − value over terms [begin, end); its Jacobian is constant.
  struct Linear {
    Index begin, end;
    Index row;
    Scalar value;
  };

  struct Term {
    Index coordinate;
    Scalar coefficient;
  };

  void lower_dot(const DotConstraint& constraint, Index row, const Layout& layout);
  void lower_bilinear(const BilinearConstraint& constraint, Index row, const Layout& layout);
  void lower_linear(const LinearConstraint& constraint, Index row);
  template <typename Constraint>
  Dot slotted(const Constraint& constraint, Index row, const Layout& layout) const;
  /// Of all constraints, in the order of the rows.
  void list_coordinates(const Model& model, const Layout& layout);
  void clear_driven_values(const Model& model);
  template <int dimension>
  void evaluate_quadratic(const Scalar* q, bool jacobian);
  template <int dimension>
  void evaluate_velocity_term(const Scalar* v, Scalar* term) const;

  Index variables_;
  int dimension_;
  Index quadratic_;
  std::vector<Distance> distances_;
  std::vector<Dot> dots_;
  std::vector<Bilinear> bilinears_;
  std::vector<Linear> linears_;
  std::vector<Term> terms_;
  std::vector<Index> coordinates_;  ///< those that a constraint has, one constraint after the other
  std::vector<Index> ends_;         ///< of each constraint in coordinates_
  Vector Phi_;
  Vector jacobian_;  ///< n×m column-major, then the scratch place
};

}  // namespace mbs::eigen_dense
