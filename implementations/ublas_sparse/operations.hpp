// The three operations of Table 2, one at a time, on the matrices that the step uses.
#pragma once

#include "assembly.hpp"
#include "matrices.hpp"
#include "mbs/operations.hpp"

namespace mbs::ublas_sparse {

/// `Product` is ExpressionProduct or AxpyProduct. No operation allocates.
template <class Product>
class UblasOperations final : public Operations {
 public:
  explicit UblasOperations(const Model& model)
      : constraints_(model), matrices_(mass_matrix(model), constraints_.jacobian_storage()) {}

  void set_coordinates(std::span<const double> q) override { constraints_.move_to(q); }
  void evaluate_jacobian() override { constraints_.evaluate_jacobian(matrices_.Phi_q); }
  void rank_update() override { matrices_.rank_update(); }
  void add_mass(double factor) override { matrices_.add_mass(factor); }

  void get_jacobian(std::span<double> dense) const override;
  void get_rank_update(std::span<double> dense) const override;
  void get_sum(std::span<double> dense) const override;

 private:
  Constraints constraints_;
  TangentMatrices<Product> matrices_;
};

}  // namespace mbs::ublas_sparse
