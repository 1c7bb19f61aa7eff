// How the constraint forces change with q: the geometric stiffness of Eq. (16).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::eigen_dense {

/// (Δt²/4) Σ_k g_k ∇²Φ_k, constraint by constraint. With u = r_a − r_b and w = r_c − r_d of the
/// free points alone, as linear functions of q, Φ = u·B w has ∇²Φ = (∂u)ᵀ B ∂w + (∂w)ᵀ Bᵀ ∂u, so
/// that free points i and j have the block
///
///     u_i w_j B + w_i u_j Bᵀ,    u_i, w_i: the factors of point i in u and w
template <typename Scalar>
class GeometricStiffness {
 public:
  using Vector = Eigen::VectorX<Scalar>;

  GeometricStiffness(const Model& model, const StepSettings& settings, const Layout& layout);

  /// Whether it is zero always.
  [[nodiscard]] bool empty() const { return constraints_.empty(); }

  /// Keeps g (m) of Eq. (16).
  template <typename Derived>
  void keep(const Eigen::MatrixBase<Derived>& g) {
    weights_ = scale_ * g;
  }
  /// Adds it to the lower triangle of T (n×n); the other half is scratch.
  template <typename MatrixScalar>
  void add_tangent(Eigen::MatrixX<MatrixScalar>& T) const;
  /// y (n) += its product with x (n).
  void add_product(const Vector& x, Vector& y) const;

 private:
  struct Quadratic {
    Shares shares;  ///< its free points
    Eigen::Index row;
    Eigen::Matrix<Scalar, 3, 3> B;  ///< the unit matrix if it is a dot constraint
  };

  template <int dimension, typename MatrixScalar>
  void add_blocks(Eigen::MatrixX<MatrixScalar>& T) const;
  template <int dimension>
  void add_products(const Scalar* x, Scalar* y) const;

  int dimension_;
  Scalar scale_;  ///< Δt²/4, s²
  std::vector<Quadratic> constraints_;
  Vector weights_;  ///< m; (Δt²/4) g
};

/// In its place where the setting is off.
struct NoGeometricStiffness {
  NoGeometricStiffness(const Model&, const StepSettings&, const Layout&) {}
  [[nodiscard]] static constexpr bool empty() { return true; }
  template <typename Expression>
  void keep(const Expression&) {}
  template <typename Matrix>
  void add_tangent(Matrix&) const {}
  template <typename Vector>
  void add_product(const Vector&, Vector&) const {}
};

}  // namespace mbs::eigen_dense
