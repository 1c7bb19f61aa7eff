// Row-by-row (bordering) Cholesky inside the envelope.
#include "reference/envelope_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mbs {

EnvelopeCholesky::EnvelopeCholesky(std::vector<int> first)
    : n_(static_cast<int>(first.size())), first_(std::move(first)) {
  std::size_t size = 0;
  for (int i = 0; i < n_; ++i) {
    start_.push_back(size - static_cast<std::size_t>(first_[i]));
    size += static_cast<std::size_t>(i - first_[i] + 1);
  }
  values_.resize(size);
}

void EnvelopeCholesky::set_zero() { std::fill(values_.begin(), values_.end(), Real{0}); }

bool EnvelopeCholesky::factorize() {
  for (int i = 0; i < n_; ++i) {
    for (int j = first_[i]; j <= i; ++j) {
      Real sum = at(i, j);
      for (int k = std::max(first_[i], first_[j]); k < j; ++k) sum -= at(i, k) * at(j, k);
      if (i == j) {
        if (!(sum > 0)) return false;
        at(i, i) = std::sqrt(sum);
      } else {
        at(i, j) = sum / at(j, j);
      }
    }
  }
  return true;
}

void EnvelopeCholesky::solve(std::vector<Real>& b) const {
  for (int i = 0; i < n_; ++i) {
    for (int k = first_[i]; k < i; ++k) b[i] -= entry(i, k) * b[k];
    b[i] /= entry(i, i);
  }
  for (int i = n_ - 1; i >= 0; --i) {
    b[i] /= entry(i, i);
    for (int k = first_[i]; k < i; ++k) b[k] -= entry(i, k) * b[i];
  }
}

}  // namespace mbs
