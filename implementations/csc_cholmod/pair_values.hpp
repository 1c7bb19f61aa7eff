// The numbers of one block of constraints u . B w = s.
#pragma once

#include <vector>

#include "pair_block.hpp"

namespace mbs::csc_cholmod {

/// Differences u, w of whatever vector was taken last, coordinates or velocities.
class PairValues {
 public:
  /// `block` must outlive this.
  explicit PairValues(const PairBlock& block);

  /// Takes u, w, B w and B^T u from x (all places).
  void take(const double* x);
  /// The block's part of all Jacobian values. Eq. (7)
  void write_jacobian(double* values) const;
  /// result (all rows) += factor * u . B w.
  void add_products(double factor, double* result) const;
  /// result (all rows) += the rates of u . B w for velocities v (all places).
  void add_rates(const double* v, double* result) const;

 private:
  [[nodiscard]] const double* Bw() const { return Bw_.empty() ? w_.data() : Bw_.data(); }
  [[nodiscard]] const double* Btu() const { return Btu_.empty() ? u_.data() : Btu_.data(); }
  void multiply_matrix();

  const PairBlock& block_;
  std::vector<double> u_, w_;     ///< as in the block
  std::vector<double> Bw_, Btu_;  ///< likewise; empty where B is the identity
};

}  // namespace mbs::csc_cholmod
