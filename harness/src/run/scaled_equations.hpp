// Constraints multiplied by numbers that make them weigh alike, for any implementation.
#pragma once

#include <memory>
#include <vector>

#include "registry/registry.hpp"

namespace mbs {

/// The model with d_k Phi_k for Phi_k: d_k is the power of two that brings the diagonal entry of
/// S = Phi_q M^-1 Phi_q^T (diagonal of M, at the start) within a factor of two of their mean, and 1
/// for driven values. The motion is the same, lambda_k is divided by d_k; the penalty form's alpha
/// becomes alpha d_k^2 for each. A dot constraint becomes a bilinear one with B = d_k I.
class ScaledEquations {
 public:
  explicit ScaledEquations(const Model& model);

  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] const std::vector<double>& factors() const { return factors_; }

  /// A simulation of `original` that `variant` does on model(). This must outlive it.
  [[nodiscard]] std::unique_ptr<Simulation> create(const Variant& variant, const Model& original,
                                                   const StepSettings& settings) const;

 private:
  std::vector<double> factors_;  // d
  std::unique_ptr<Model> model_;
};

}  // namespace mbs
