// The numbers of a program's fronts, for simulations side by side: block L D Lᵀ.
#pragma once

#include <algorithm>

#include "panels/block.hpp"
#include "panels/vectors.hpp"
#include "program.hpp"
#include "scalar.hpp"

namespace mbs::compiled_ldl {

/// Columns keep L D below their pivot: L is that times the inverse pivot. The columns of the
/// example of Panels, (4 2 | 2) and (· 5 | 9), become (4 2 | 2) and (· 4 | 8), with inverse_ = (¼,
/// ¼). Row and column behind lose 17, and y = (4 6 | 0) becomes (4 4 | −10).
template <typename F>
class Fronts {
 public:
  /// `definite`: only positive pivots are accepted.
  Fronts(const Program& program, bool definite);

  /// What every factorization begins with.
  F* constants() { return constants_.data(); }
  /// The matrix, valid from start() until factorize().
  F* matrix() { return matrix_.data(); }
  void start() { std::copy(constants_.begin(), constants_.end(), matrix_.begin()); }

  /// Factorizes and solves for y, which is padded; false if a pivot is not accepted.
  bool factorize_and_solve(F* y);
  void solve(F* y) const;
  /// Below zero in the lanes where a pivot was not accepted.
  [[nodiscard]] const F& least_pivot() const { return least_; }

 private:
  void factorize(const Front& front, F* y);
  void pivot_columns(const Front& front, F* columns, int j, int end, F* y);
  void update_column(const Front& front, const F* columns, int from, int to, F* target, int row);
  void update_border(const Front& front, F* y);
  void scatter(const Front& front, const Group& group, int k);
  void forward(const Front& front, F* y) const;
  void backward(const Front& front, F* y) const;
  void check(const F& inverse);

  const Program& program_;
  bool definite_;
  Array<F> constants_, matrix_;
  Array<F> inverse_;       // of the pivots
  mutable Array<F> work_;  // a column
  F least_ = 1.0;
};

// Factorization of the fronts one after the other.

template <typename F>
Fronts<F>::Fronts(const Program& program, bool definite)
    : program_(program),
      definite_(definite),
      constants_(program.storage, F(0.0)),
      matrix_(program.storage, F(0.0)),
      inverse_(program.padded, F(0.0)) {
  int longest = 0;
  for (const Front& front : program.fronts) longest = std::max(longest, front.stride);
  work_.resize(longest, F(0.0));
}

template <typename F>
bool Fronts<F>::factorize_and_solve(F* y) {
  least_ = F(1.0);
  for (const Front& front : program_.fronts) factorize(front, y);
  for (auto front = program_.fronts.rbegin(); front != program_.fronts.rend(); ++front) {
    backward(*front, y);
  }
  if constexpr (kLanesOf<F> == 1) return least_ > F(0.0);
  return true;
}

/// A pivot of zero or NaN has an inverse that is not finite, an infinite one has zero.
template <typename F>
void Fronts<F>::check(const F& inverse) {
  const F measure = definite_ ? inverse : inverse * inverse;
  if constexpr (kLanesOf<F> == 1) {
    least_ = measure > F(0.0) && inverse - inverse == F(0.0) ? least_ : F(-1.0);
  } else {
    const auto finite = inverse.v - inverse.v;
    least_.v = measure.v > finite ? least_.v : Lanes(-1.0).v;
  }
}

template <typename F>
void Fronts<F>::factorize(const Front& front, F* y) {
  F* columns = matrix_.data() + front.base;
  for (int from = 0; from < front.pivots; from += kPanel) {
    const int to = std::min(from + kPanel, front.pivots);
    for (int j = from; j < to; j += 2) pivot_columns(front, columns, j, to, y);
    for (int k = to; k < front.pivots; ++k) {
      update_column(front, columns, from, to, columns + k * front.stride, k);
    }
  }
  if (front.border > 0) update_border(front, y);
}

/// Eliminates pivots j and j + 1 from the columns before `end` and from the pivots' right-hand
/// side, as decompose() of panels/block.hpp does.
template <typename F>
void Fronts<F>::pivot_columns(const Front& front, F* columns, int j, int end, F* y) {
  F* one = columns + j * front.stride;
  const F inverse = F(1.0) / one[j];
  check(inverse);
  F* inverses = inverse_.data() + front.first;
  inverses[j] = inverse;
  const int rows = front.pivots + front.border;
  const F z = y[front.first + j] * inverse;
  for (int i = j + 1; i < front.pivots; ++i) y[front.first + i] -= one[i] * z;
  if (j + 1 == end) return;
  F* other = one + front.stride;
  const F of_pair = F(1.0) / determinant(one[j], one[j + 1], other[j + 1]);
  check(of_pair);
  inverses[j + 1] = one[j] * of_pair;
  const F factor = one[j + 1] * inverse;
  for (int i = j + 1; i < rows; ++i) other[i] -= one[i] * factor;
  for (int k = j + 2; k < end; ++k) {
    const F factor1 = one[k] * inverse, factor2 = other[k] * inverses[j + 1];
    F* target = columns + k * front.stride;
    for (int i = k; i < rows; ++i) target[i] = (target[i] - one[i] * factor1) - other[i] * factor2;
  }
  const F z2 = y[front.first + j + 1] * inverses[j + 1];
  for (int i = j + 2; i < front.pivots; ++i) y[front.first + i] -= other[i] * z2;
}

/// target -= Σ_j column_j (column_j)_row / d_j over pivots from … to - 1, from row `row` on.
template <typename F>
void Fronts<F>::update_column(const Front& front, const F* columns, int from, int to, F* target,
                              int row) {
  const int rows = front.stride;
  const F* inverse = inverse_.data() + front.first;
  F factors[8];
  for (int j = from; j < to; ++j) {
    factors[j - from] = columns[j * front.stride + row] * inverse[j];
  }
  for (int i = row; i < rows; ++i) {
    F sum = target[i];
    for (int j = from; j < to; ++j) {
      sum -= factors[j - from] * columns[j * front.stride + i];
    }
    target[i] = sum;
  }
}

template <typename F>
void Fronts<F>::update_border(const Front& front, F* y) {
  F* columns = matrix_.data() + front.base;
  const int p = front.pivots;
  for (int g = front.groups_begin; g < front.groups_end; ++g) {
    const Group& group = program_.groups[g];
    for (int k = group.begin; k < group.end; ++k) {
      const int rows = front.stride;
      for (int i = p + k; i < rows; ++i) work_[i] = F(0.0);
      for (int from = 0; from < p; from += 8) {
        update_column(front, columns, from, std::min(from + 8, p), work_.data(), p + k);
      }
      scatter(front, group, k);
    }
  }
  const int* rows = program_.border_rows.data() + front.rows;
  for (int j = 0; j < p; ++j) {
    const F z = y[front.first + j] * inverse_[front.first + j];
    const F* column = columns + j * front.stride + p;
    for (int i = 0; i < front.border; ++i) y[rows[i]] -= column[i] * z;
  }
}

/// Adds work_ to the column that border column k goes to.
template <typename F>
void Fronts<F>::scatter(const Front& front, const Group& group, int k) {
  const int* places = program_.positions.data() + group.positions - group.begin;
  F* target = matrix_.data() + group.base + (k - group.begin) * group.stride;
  const F* source = work_.data() + front.pivots;
  if (group.contiguous) {
    F* from_k = target + places[k];
    for (int i = k; i < front.border; ++i) from_k[i - k] += source[i];
  } else {
    for (int i = k; i < front.border; ++i) target[places[i]] += source[i];
  }
}

// Substitution with the factors there are.

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
