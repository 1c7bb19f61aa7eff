// The union pattern of T and the schedules that update it, found once.
#pragma once

#include <array>
#include <vector>

#include "element_shares.hpp"
#include "force_pattern.hpp"
#include "jacobian_pattern.hpp"
#include "shallow_order.hpp"
#include "storage.hpp"

namespace mbs::csc_klu {

/// The union pattern of M, Phi_q^T Phi_q, C and K, and what updates it. For Phi_q^T Phi_q: for
/// every dim x dim block of it which Jacobian blocks to multiply and where the values go.
template <int dim>
struct TangentPattern {
  using Columns = std::array<int, dim>;  ///< offset of the first row of each column of a block

  /// Block (p, p): the sum over the point's own, consecutive Jacobian blocks.
  struct Diagonal {
    int begin, end;  ///< Jacobian blocks
    Columns columns;
  };
  /// Blocks (p, q), p < q, and (q, p), its transpose: one product of two Jacobian blocks.
  struct Coupling {
    int left, right;  ///< Jacobian blocks of p and q, of the same constraint
    Columns above;    ///< columns of (p, q)
    Columns below;    ///< columns of (q, p)
  };
  /// One product of two coefficients of a linear constraint, Eq. (8): a constant.
  struct Constant {
    int at;  ///< offset
    double product;
  };

  TangentPattern(const Model& model, const JacobianPattern<dim>& jacobian,
                 const ForcePattern& forces, Order elimination = Order::shallow);

  Pattern pattern;
  std::vector<int> order;  ///< of elimination
  std::vector<Diagonal> diagonals;
  std::vector<Coupling> couplings;          ///< the first product for each pair of points
  std::vector<Coupling> further_couplings;  ///< more products for pairs that have them
  std::vector<Constant> constants;          ///< all of the linear constraints' Phi_q^T Phi_q
  ElementShares<dim> shares;                ///< C and K
};

}  // namespace mbs::csc_klu
