// What springs add to a matrix, (dt/2) C + (dt^2/4) K, and where it goes.
#include "element_shares.hpp"

#include <cstddef>

#include "point_vector.hpp"

namespace mbs::csc_klu {

template <int dim>
ElementShares<dim>::ElementShares(const std::vector<ElementBlock>& elements, const Pattern& pattern,
                                  const std::function<bool(int, int)>& is_written) {
  const ElementBlock* before = nullptr;
  for (const ElementBlock& block : elements) {
    const bool repeated = before != nullptr && before->p == block.p && before->q == block.q;
    Share share{block.element, block.left, block.right, block.sign, {}};
    for (int k = 0; k < dim; ++k) {
      share.columns[k] = pattern.offset(dim * block.p, dim * block.q + k);
    }
    (repeated || is_written(block.p, block.q) ? further_ : first_).push_back(share);
    before = &block;
  }
}

template <int dim>
void ElementShares<dim>::add(const Forces<dim>& forces, const double* constant,
                             double* value) const {
  const auto add_share = [&](const Share& share, const double* base) {
    const double along = forces.along(share.element);
    const double across = forces.across(share.element) * share.sign;
    Vector<dim> left, right;
    for (int k = 0; k < dim; ++k) left[k] = forces.gradient(share.left)[k];
    for (int k = 0; k < dim; ++k) right[k] = forces.gradient(share.right)[k];
    for (int col = 0; col < dim; ++col) {
      const int at = share.columns[col];
      add_column(base + at, left, along * right[col], value + at);  // Eq. (11)
      value[at + col] += across;                                    // Eq. (11)
    }
  };
  for (const Share& share : first_) add_share(share, constant);
  for (const Share& share : further_) add_share(share, value);
}

template class ElementShares<2>;
template class ElementShares<3>;

}  // namespace mbs::csc_klu
