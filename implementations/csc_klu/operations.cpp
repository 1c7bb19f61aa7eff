// The three operations of the paper's Table 2, each alone, with the step's own storage.
#include "operations.hpp"

#include <algorithm>
#include <vector>

#include "extended_points.hpp"
#include "jacobian.hpp"
#include "storage.hpp"
#include "tangent.hpp"

namespace mbs::csc_klu {
namespace {

/// The Jacobian and the rank-k update are the classes of the step; Phi comes with the Jacobian. M
/// is spread over the pattern of the tangent matrix, so that the addition is one vector operation.
template <int dim>
class SparseOperations final : public Operations {
 public:
  explicit SparseOperations(const Model& model)
      : n_(model.variables()),
        jacobian_pattern_(model),
        jacobian_(jacobian_pattern_),
        tangent_pattern_(model, jacobian_pattern_, ForcePattern(model)),
        product_(tangent_pattern_, std::vector<double>(tangent_pattern_.pattern.entries(), 0.0),
                 1.0),
        mass_(mass_values(model, tangent_pattern_.pattern)),
        sum_(mass_.size(), 0.0),
        q_(model.initial_position().begin(), model.initial_position().end()),
        phi_(model.constraints(), 0.0) {
    const std::vector<double> fixed = fixed_coordinates(model);
    q_.insert(q_.end(), fixed.begin(), fixed.end());
  }

  void set_coordinates(std::span<const double> q) override { std::ranges::copy(q, q_.begin()); }
  void evaluate_jacobian() override { jacobian_.evaluate(q_.data(), phi_.data()); }
  void rank_update() override { product_.assemble(jacobian_); }

  void add_mass(double factor) override {
    const double* __restrict const mass = mass_.data();
    const double* __restrict const product = product_.values().data();
    double* __restrict const sum = sum_.data();
    const std::size_t entries = sum_.size();
    for (std::size_t k = 0; k < entries; ++k) sum[k] = mass[k] + factor * product[k];
  }

  void get_jacobian(std::span<double> dense) const override {
    const JacobianPattern<dim>& pattern = jacobian_pattern_;
    std::ranges::fill(dense, 0.0);
    for (int p = 0; p < pattern.points(); ++p) {
      for (int block = pattern.block_begin[p]; block < pattern.block_begin[p + 1]; ++block) {
        double* const row = dense.data() + row_begin(pattern.block_row[block]) + dim * p;
        std::copy_n(jacobian_.block(block), dim, row);
      }
    }
    int k = 0;
    for (int i = 0; i < std::ssize(pattern.linears); ++i) {
      double* const row = dense.data() + row_begin(pattern.quadratics() + i);
      for (; k < pattern.linears[i].terms_end; ++k) {
        row[pattern.linear_terms[k].coordinate] = pattern.linear_terms[k].coefficient;
      }
    }
  }

  void get_rank_update(std::span<double> dense) const override { expand(product_.values(), dense); }
  void get_sum(std::span<double> dense) const override { expand(sum_, dense); }

 private:
  /// Where the model's row of a constraint of JacobianPattern begins in a dense Jacobian.
  [[nodiscard]] std::size_t row_begin(int constraint) const {
    return static_cast<std::size_t>(jacobian_pattern_.model_row[constraint]) * n_;
  }

  void expand(std::span<const double> values, std::span<double> dense) const {
    const Pattern& pattern = tangent_pattern_.pattern;
    std::ranges::fill(dense, 0.0);
    for (int col = 0; col < n_; ++col) {
      for (int k = pattern.column_begin[col]; k < pattern.column_begin[col + 1]; ++k) {
        dense[static_cast<std::size_t>(pattern.row[k]) * n_ + col] = values[k];
      }
    }
  }

  const int n_;
  const JacobianPattern<dim> jacobian_pattern_;
  Jacobian<dim> jacobian_;
  const TangentPattern<dim> tangent_pattern_;
  Tangent<dim> product_;            ///< Phi_q^T Phi_q: a tangent matrix without mass, factor 1
  const std::vector<double> mass_;  ///< on the pattern of the tangent matrix, like sum_
  std::vector<double> sum_;
  std::vector<double> q_;    ///< extended by the fixed points
  std::vector<double> phi_;  ///< m
};

}  // namespace

std::unique_ptr<Operations> create_operations(const Model& model) {
  if (model.dimension() == 2) return std::make_unique<SparseOperations<2>>(model);
  return std::make_unique<SparseOperations<3>>(model);
}

}  // namespace mbs::csc_klu
