// What a spring, torsion spring or law gives to C and K, element by element.
#pragma once

#include <Eigen/Core>
#include <array>

#include "layout.hpp"

namespace mbs::eigen_dense {

/// One element's part of W = (Δt/2) C + (Δt²/4) K in Eqs. (5) and (15), kept as
///
///     W = along g gᵀ + across H,    along = (Δt/2) c + (Δt²/4) (k − p),    across = (Δt²/4) p
///
/// with H = [I, −I; −I, I] for the points a and b, because the geometric stiffness along a line is
/// G = p (H − g gᵀ), Eqs. (11) and (18). About an axis p = 0.
template <typename Scalar>
struct Element {
  Shares shares;     ///< its free points
  Scalar along = 0;  ///< at the last evaluation, like the following
  Scalar across = 0;
  std::array<Scalar, 12> g{};  ///< `dimension` numbers a free point

  template <int dimension>
  using Vector = Eigen::Matrix<Scalar, dimension, 1>;

  /// Keeps g, `g_u` at a, −`g_u` at b, `g_w` at c, −`g_w` at d, and adds `force` g to rhs (n).
  template <int dimension>
  void apply(const Vector<dimension>& g_u, const Vector<dimension>& g_w, Scalar force,
             Scalar* rhs) {
    Scalar* part = g.data();
    for (const Share& share : shares) {
      Eigen::Map<Vector<dimension>> here(part);
      here = Scalar(share.in_u) * g_u + Scalar(share.in_w) * g_w;
      Eigen::Map<Vector<dimension>>(rhs + share.start) += force * here;
      part += dimension;
    }
  }

  /// Adds W to the lower triangle of T (n×n); what it writes above the diagonal is scratch.
  template <int dimension, typename MatrixScalar>
  void add_tangent(Eigen::MatrixX<MatrixScalar>& T) const {
    for (int j = 0; j < shares.count; ++j) {
      const Eigen::Map<const Vector<dimension>> g_j(g.data() + j * dimension);
      for (int i = j; i < shares.count; ++i) {  // ascending coordinates: row >= column
        const Eigen::Map<const Vector<dimension>> g_i(g.data() + i * dimension);
        auto block =
            T.template block<dimension, dimension>(shares.items[i].start, shares.items[j].start);
        block += (g_i * (along * g_j).transpose()).template cast<MatrixScalar>();
        block.diagonal().array() +=
            MatrixScalar(across * shares.items[i].in_u * shares.items[j].in_u);
      }
    }
  }

  /// y (n) += W x (n).
  template <int dimension>
  void add_product(const Scalar* x, Scalar* y) const {
    Scalar sum = 0;
    Vector<dimension> stretch = Vector<dimension>::Zero();
    const Scalar* part = g.data();
    for (const Share& share : shares) {
      const Eigen::Map<const Vector<dimension>> here(x + share.start);
      sum += Eigen::Map<const Vector<dimension>>(part).dot(here);
      stretch += Scalar(share.in_u) * here;
      part += dimension;
    }
    part = g.data();
    for (const Share& share : shares) {
      Eigen::Map<Vector<dimension>>(y + share.start) +=
          along * sum * Eigen::Map<const Vector<dimension>>(part) +
          across * Scalar(share.in_u) * stretch;
      part += dimension;
    }
  }
};

}  // namespace mbs::eigen_dense
