// The tangent matrix T of Eq. (5): rank-k update and matrix addition in one sweep, then C and K.
#include "tangent.hpp"

#include <array>
#include <utility>

#include "point_vector.hpp"

namespace mbs::csc_klu {

template <int dim>
Tangent<dim>::Tangent(const TangentPattern<dim>& pattern, std::vector<double> base, double factor)
    : pattern_(pattern), factor_(factor), constant_(std::move(base)) {
  for (const auto& constant : pattern.constants) {
    constant_[constant.at] += factor * constant.product;
  }
  values_ = constant_;
}

template <int dim>
void Tangent<dim>::assemble(const Jacobian<dim>& jacobian) {
  const double* const constant = constant_.data();
  double* const value = values_.data();
  for (const auto& diagonal : pattern_.diagonals) {
    std::array<std::array<double, dim>, dim> product{};
    for (int block = diagonal.begin; block < diagonal.end; ++block) {
      const double* const j = jacobian.block(block);
      for (int col = 0; col < dim; ++col) {
        for (int row = 0; row < dim; ++row) product[col][row] += j[row] * j[col];
      }
    }
    for (int col = 0; col < dim; ++col) {
      const int at = diagonal.columns[col];
      add_column(constant + at, product[col], factor_, value + at);  // Eq. (5)
    }
  }
  const auto couple = [&](const auto& coupling, const double* base) {
    std::array<double, dim> left, right;  // filled by loops: std::copy_n is slower here
    for (int k = 0; k < dim; ++k) left[k] = jacobian.block(coupling.left)[k];
    for (int k = 0; k < dim; ++k) right[k] = jacobian.block(coupling.right)[k];
    for (int col = 0; col < dim; ++col) {
      const int above = coupling.above[col], below = coupling.below[col];
      add_column(base + above, left, factor_ * right[col], value + above);  // Eq. (5)
      add_column(base + below, right, factor_ * left[col], value + below);  // Eq. (5)
    }
  };
  for (const auto& coupling : pattern_.couplings) couple(coupling, constant);
  for (const auto& coupling : pattern_.further_couplings) couple(coupling, value);
}

template class Tangent<2>;
template class Tangent<3>;

}  // namespace mbs::csc_klu
