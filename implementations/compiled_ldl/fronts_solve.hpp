// Fronts<F>: substitution with the factors there are. Part of fronts.hpp.
#pragma once

#include "fronts.hpp"

namespace mbs::compiled_ldl {

template <typename F>
void Fronts<F>::solve(F* y) const {
  for (const Front& front : program_.fronts) forward(front, y);
  for (auto front = program_.fronts.rbegin(); front != program_.fronts.rend(); ++front) {
    backward(*front, y);
  }
}

template <typename F>
void Fronts<F>::forward(const Front& front, F* y) const {
  const int* rows = program_.border_rows.data() + front.rows;
  for (int j = 0; j < front.pivots; ++j) {
    const F z = y[front.first + j] * inverse_[front.first + j];
    const F* column = matrix_.data() + front.base + j * front.stride;
    for (int i = j + 1; i < front.pivots; ++i) y[front.first + i] -= column[i] * z;
    for (int i = 0; i < front.border; ++i) y[rows[i]] -= column[front.pivots + i] * z;
  }
}

template <typename F>
void Fronts<F>::backward(const Front& front, F* y) const {
  const int* rows = program_.border_rows.data() + front.rows;
  F* border = work_.data();
  for (int i = 0; i < front.border; ++i) border[i] = y[rows[i]];
  F* x = y + front.first;
  for (int j = front.pivots - 1; j >= 0; --j) {
    const F* column = matrix_.data() + front.base + j * front.stride;
    F sum = x[j];
    for (int i = 0; i < front.border; ++i) sum -= column[front.pivots + i] * border[i];
    for (int i = j + 1; i < front.pivots; ++i) sum -= column[i] * x[i];
    x[j] = sum * inverse_[front.first + j];
  }
}

}  // namespace mbs::compiled_ldl
