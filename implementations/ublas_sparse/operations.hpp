// The three operations of Table 2, one at a time, on the matrices that the step uses.
#pragma once

#include "assembly.hpp"
#include "matrices.hpp"
#include "mbs/operations.hpp"
#include "points.hpp"

namespace mbs::ublas_sparse {

/// `Product` is ExpressionProduct or AxpyProduct. No operation allocates.
template <class Product>
class UblasOperations final : public Operations {
 public:
  explicit UblasOperations(const Model& model)
      : points_(model),
        constraints_(model, points_),
        M_(mass_matrix(model)),
        matrices_(M_, constraints_.jacobian_storage(points_)) {}

  void set_coordinates(std::span<const double> q) override { points_.move_to(q); }
  void evaluate_jacobian() override { constraints_.evaluate_jacobian(points_, matrices_.Phi_q); }
  void rank_update() override { matrices_.rank_update(); }
  void add_mass(double factor) override { matrices_.add(M_, factor); }

  void get_jacobian(std::span<double> dense) const override;
  void get_rank_update(std::span<double> dense) const override;
  void get_sum(std::span<double> dense) const override;

 private:
  Points points_;
  Constraints constraints_;
  SparseMatrix M_;
  TangentMatrices<Product> matrices_;
};

}  // namespace mbs::ublas_sparse
