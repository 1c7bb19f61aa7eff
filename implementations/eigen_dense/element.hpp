// What a spring or torsion spring gives to C and K, element by element.
#pragma once

#include <Eigen/Core>
#include <array>

#include "layout.hpp"

namespace mbs::eigen_dense {

/// One element's part of W = (Δt/2) C + (Δt²/4) K in Eqs. (5) and (6), kept as
///
///     W = along g gᵀ + across H,    along = (Δt/2) c + (Δt²/4) (k − p),    across = (Δt²/4) p
///
/// with H = [I, −I; −I, I] for the points a and b, because the geometric stiffness of a spring is
/// G = p (H − g gᵀ), Eq. (11). A torsion spring has p = 0.
struct Element {
  Shares shares;          ///< its free points
  double weight = 0.0;    ///< (Δt/2) c + (Δt²/4) k
  double along = weight;  ///< at the last evaluation, like the following
  double across = 0.0;
  std::array<double, 12> g{};  ///< `dimension` numbers a free point

  template <int dimension>
  using Vector = Eigen::Matrix<double, dimension, 1>;

  /// Keeps g, `g_u` at a, −`g_u` at b, `g_w` at c, −`g_w` at d, and adds `force` g to rhs (n).
  template <int dimension>
  void apply(const Vector<dimension>& g_u, const Vector<dimension>& g_w, double force,
             double* rhs) {
    double* part = g.data();
    for (const Share& share : shares) {
      Eigen::Map<Vector<dimension>> here(part);
      here = share.in_u * g_u + share.in_w * g_w;
      Eigen::Map<Vector<dimension>>(rhs + share.start) += force * here;
      part += dimension;
    }
  }

  /// Adds W to the lower triangle of T (n×n); what it writes above the diagonal is scratch.
  template <int dimension>
  void add_tangent(Eigen::MatrixXd& T) const {
    for (int j = 0; j < shares.count; ++j) {
      const Eigen::Map<const Vector<dimension>> g_j(g.data() + j * dimension);
      for (int i = j; i < shares.count; ++i) {  // ascending coordinates: row >= column
        const Eigen::Map<const Vector<dimension>> g_i(g.data() + i * dimension);
        auto block = T.block<dimension, dimension>(shares.items[i].start, shares.items[j].start);
        block += g_i * (along * g_j).transpose();
        block.diagonal().array() += across * shares.items[i].in_u * shares.items[j].in_u;
      }
    }
  }

  /// y (n) += W x (n).
  template <int dimension>
  void add_product(const double* x, double* y) const {
    double sum = 0.0;
    Vector<dimension> stretch = Vector<dimension>::Zero();
    const double* part = g.data();
    for (const Share& share : shares) {
      const Eigen::Map<const Vector<dimension>> here(x + share.start);
      sum += Eigen::Map<const Vector<dimension>>(part).dot(here);
      stretch += share.in_u * here;
      part += dimension;
    }
    part = g.data();
    for (const Share& share : shares) {
      Eigen::Map<Vector<dimension>>(y + share.start) +=
          along * sum * Eigen::Map<const Vector<dimension>>(part) + across * share.in_u * stretch;
      part += dimension;
    }
  }
};

}  // namespace mbs::eigen_dense
