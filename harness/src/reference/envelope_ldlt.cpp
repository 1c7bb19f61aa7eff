// Row by row (bordering) inside the envelope.
#include "reference/envelope_ldlt.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mbs {

EnvelopeLdlt::EnvelopeLdlt(std::vector<int> first)
    : n_(static_cast<int>(first.size())), first_(std::move(first)) {
  std::size_t size = 0;
  for (int i = 0; i < n_; ++i) {
    start_.push_back(size - static_cast<std::size_t>(first_[i]));
    size += static_cast<std::size_t>(i - first_[i] + 1);
  }
  values_.resize(size);
}

void EnvelopeLdlt::set_zero() { std::fill(values_.begin(), values_.end(), Real{0}); }

bool EnvelopeLdlt::factorize(std::optional<int> negative) {
  int found = 0;
  for (int i = 0; i < n_; ++i) {
    for (int j = first_[i]; j < i; ++j) {  // row i of L D
      Real sum = at(i, j);
      for (int k = std::max(first_[i], first_[j]); k < j; ++k) sum -= at(i, k) * at(j, k);
      at(i, j) = sum;
    }
    for (int k = first_[i]; k < i; ++k) {
      const Real scaled = at(i, k) / at(k, k);
      at(i, i) -= at(i, k) * scaled;
      at(i, k) = scaled;
    }
    const Real pivot = at(i, i);
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    found += pivot < 0;
  }
  return found == negative.value_or(found);
}

void EnvelopeLdlt::solve(std::vector<Real>& b) const {
  for (int i = 0; i < n_; ++i) {
    for (int k = first_[i]; k < i; ++k) b[i] -= entry(i, k) * b[k];
  }
  for (int i = n_ - 1; i >= 0; --i) b[i] /= entry(i, i);
  for (int i = n_ - 1; i >= 0; --i) {
    for (int k = first_[i]; k < i; ++k) b[k] -= entry(i, k) * b[i];
  }
}

}  // namespace mbs
