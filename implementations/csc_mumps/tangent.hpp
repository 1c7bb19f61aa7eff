// T, Eq. (5), the matrix of the penalty form.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "assembly.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "pattern.hpp"

namespace mbs::csc_mumps {

/// The lower triangle of T on the union of the patterns of M, Phi_q' Phi_q and K.
class Tangent {
 public:
  /// `assembly` is that of `model` and outlives this.
  Tangent(const Model& model, const Assembly& assembly, const StepSettings& settings);

  [[nodiscard]] const ColumnPattern& pattern() const { return pattern_; }
  /// One an entry of the pattern; never moves.
  [[nodiscard]] std::span<double> values() { return values_; }

  /// The values, for the Phi_q and forces evaluated last. False if there is a NaN or an infinity.
  [[nodiscard]] bool evaluate();

 private:
  /// One of the products that sum up to an entry of T, or just an entry (left = -1).
  struct Product {
    std::int64_t entry;  // column * n + row
    int left, right;
    bool operator<(const Product& other) const {
      return entry != other.entry ? entry < other.entry : left < other.left;
    }
  };

  [[nodiscard]] std::vector<Product> collect(const Model& model) const;
  void schedule(const std::vector<Product>& products);
  void fill_constant(const Model& model);

  const Assembly& assembly_;
  const int variables_;
  const double factor_;  // (Delta t^2 / 4) alpha

  // T = constant_ + factor_ update_ (+ forces), all three on pattern_. Entry target_[t] of update_
  // is the sum of Phi_q's values left_[k] times right_[k] over k in [product_start_[t],
  // product_start_[t + 1]). Linear constraints are in constant_.
  ColumnPattern pattern_;
  std::vector<double> constant_, update_, values_;
  std::vector<int> target_, product_start_, left_, right_;
  std::vector<int> force_places_;  // of the forces' entries
};

}  // namespace mbs::csc_mumps
