// The values of the saddle-point matrix of Eqs. (12) and (14).
#include "saddle_matrix.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::csc_klu {

template <int dim>
std::vector<double> multiplier_scales(const Model& model, const JacobianPattern<dim>& pattern,
                                      const Jacobian<dim>& jacobian) {
  std::vector<double> mass(model.variables(), 1.0), scales(model.constraints(), 0.0);
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == entry.col) mass[entry.row] = entry.value;
  }
  const auto include = [&](int row, int coordinate, double value) {
    scales[row] = std::max(scales[row], std::abs(value) / mass[coordinate]);
  };
  for (int p = 0; p < pattern.points(); ++p) {
    for (int block = pattern.block_begin[p]; block < pattern.block_begin[p + 1]; ++block) {
      for (int k = 0; k < dim; ++k) {
        include(pattern.block_row[block], dim * p + k, jacobian.block(block)[k]);
      }
    }
  }
  int row = pattern.quadratics(), k = 0;
  for (const auto& linear : pattern.linears) {
    for (; k < linear.terms_end; ++k) {
      include(row, pattern.linear_terms[k].coordinate, pattern.linear_terms[k].coefficient);
    }
    ++row;
  }
  for (double& scale : scales) scale = scale > 0.0 ? std::exp2(-std::round(std::log2(scale))) : 1.0;
  return scales;
}

template <int dim>
SaddleMatrix<dim>::SaddleMatrix(const SaddlePattern<dim>& pattern, const Model& model,
                                double epsilon, const std::vector<double>& scales)
    : pattern_(pattern), mass_(mass_values(model, pattern.pattern)), values_(mass_) {
  for (std::size_t i = 0; i < scales.size(); ++i) {
    values_[pattern.diagonal[i]] = -scales[i] * epsilon * scales[i];  // Eq. (12)
  }
  for (const auto& constant : pattern.constants) {
    const double value = scales[constant.row] * constant.coefficient;  // Eq. (8)
    values_[constant.above] = values_[constant.below] = value;         // Eq. (12)
  }
  for (const auto& block : pattern.blocks) block_scales_.push_back(scales[block.row]);
}

template <int dim>
void SaddleMatrix<dim>::assemble(const Jacobian<dim>& jacobian) {
  double* const value = values_.data();
  const double* j = jacobian.block(0);
  const double* scale = block_scales_.data();
  for (const auto& block : pattern_.blocks) {
    for (int k = 0; k < dim; ++k) {
      value[block.above + k] = value[block.below[k]] = *scale * j[k];  // Eq. (12)
    }
    j += dim;
    ++scale;
  }
}

template std::vector<double> multiplier_scales(const Model&, const JacobianPattern<2>&,
                                               const Jacobian<2>&);
template std::vector<double> multiplier_scales(const Model&, const JacobianPattern<3>&,
                                               const Jacobian<3>&);
template class SaddleMatrix<2>;
template class SaddleMatrix<3>;

}  // namespace mbs::csc_klu
