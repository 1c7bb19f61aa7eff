// The union pattern of M and Phi_q^T Phi_q and the schedule of the rank-k update, found once.
#pragma once

#include <array>
#include <vector>

#include "jacobian_pattern.hpp"
#include "storage.hpp"

namespace mbs::csc_klu {

/// The union pattern of M and Phi_q^T Phi_q, and the schedule that updates Phi_q^T Phi_q: for every
/// dim x dim block of it which Jacobian blocks to multiply and where the values go.
template <int dim>
struct TangentPattern {
  /// Block (p, p): the sum over the point's own, consecutive Jacobian blocks.
  struct Diagonal {
    int begin, end;                ///< Jacobian blocks
    std::array<int, dim> columns;  ///< offset of the first row of each of its columns
  };
  /// Blocks (p, q), p < q, and (q, p), its transpose: one product of two Jacobian blocks.
  struct Coupling {
    int left, right;             ///< Jacobian blocks of p and q, of the same constraint
    std::array<int, dim> above;  ///< columns of (p, q)
    std::array<int, dim> below;  ///< columns of (q, p)
  };

  /// One product of two coefficients of a linear constraint, Eq. (8): a constant.
  struct Constant {
    int at;  ///< offset
    double product;
  };

  TangentPattern(const Model& model, const JacobianPattern<dim>& jacobian);

  Pattern pattern;
  std::vector<Diagonal> diagonals;
  std::vector<Coupling> couplings;          ///< the first product for each pair of points
  std::vector<Coupling> further_couplings;  ///< more products for pairs that have them
  std::vector<Constant> constants;          ///< all of the linear constraints' Phi_q^T Phi_q
};

}  // namespace mbs::csc_klu
