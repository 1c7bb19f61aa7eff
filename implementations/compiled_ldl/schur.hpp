// Saddle-point forms in which the points' block A never changes: it is eliminated once.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "elements/constraints.hpp"
#include "inverse.hpp"
#include "panels/panels.hpp"

namespace mbs::compiled_ldl {

/// Instead of [A Φqᵀ; Φq −ε], −S = −ε − Φq A⁻¹ Φqᵀ is factorized. A row of Φq is Σ n_i e_i, of
/// which only the n_i change, so that S_kl = ε_kl + Σ_ij n_ki n_lj K_kl,ij with constant K_kl,ij =
/// e_ki · A⁻¹ e_lj. With A = 2 I, e_k1 = (2 0), e_k2 = (0 2) and e_l1 = (−2 0), e_l2 = (0 −2), K_kl
/// is −2 I; n_k = (3 4) and n_l = (1 0) make S_kl = −6. Where all axes are alike, as here, K is one
/// number for two vectors of D numbers each: S_kl = −2 (n_k · n_l).
template <int D>
class Schur {
 public:
  /// Of a program with constant fronts. A and −ε are among the constants of `panels`.
  Schur(const Program& program, const Constraints<double, D>& constraints, const Changing& changing,
        Panels<double>& panels);

  /// −S, with the gradients of the last evaluation, which solve() keeps.
  void assemble(const Constraints<double, D>& constraints);
  /// What the points have of a right-hand side: r, or A⁻¹ r.
  enum class Points { given, solved };
  /// y = solution; false if a pivot was not accepted.
  bool factorize_and_solve(double* y, Points points);
  void solve(double* y, Points points);
  /// x = A⁻¹ x.
  void solve_points(double* x);

 private:
  static constexpr int L = kWidest<double>;
  using V = typename Short<double, L>::Type;
  using Part = typename Panels<double>::Part;
  struct Entry {
    int row = 0, number = 0;  // number: which of numbers_
    double unit = 0.0;
  };

  void list_entries(const Constraints<double, D>& constraints);
  void find_products();
  void find_products_of_column(int column, std::span<const int> rows, int above);
  /// Pivots first.
  std::vector<int> rows_of(const Front& front) const;
  template <int N, bool kAlike>
  void assemble_fronts();
  template <int N, bool kAlike>
  const double* assemble_column(const Front& front, int j, int rows, const double* products);
  void eliminate_points(double* y, Points points);
  void add_forces(double* y);

  const Program& program_;
  Panels<double>& panels_;
  int first_;    // row of the first multiplier
  int count_;    // multipliers
  int numbers_;  // n_i of a row of Φq
  int apart_;    // what has a K of its own: every number, or every D-th
  bool accepted_ = true;
  std::vector<Entry> entries_;    // of e_i: row by row of Φq, in the order of the program
  std::vector<int> entries_end_;  // of each row
  Array<double> values_;          // of Φq: of each entry
  Array<double> n_;               // n_1 of all rows, then n_2 …
  Array<double> of_front_;        // the same of a front's rows
  Array<double> products_;  // of each column of the fronts, L rows at a time: K_11, K_12 …, K_21 …
  Array<double> change_;               // −Φqᵀ μ, or A⁻¹ of it
  Array<double> given_;                // what the points are solved for
  std::optional<Inverse<D>> inverse_;  // if the program is to have it
};

// Tables.

template <int D>
Schur<D>::Schur(const Program& program, const Constraints<double, D>& constraints,
                const Changing& changing, Panels<double>& panels)
    : program_(program),
      panels_(panels),
      first_(program.size - constraints.count()),
      count_(constraints.count()),
      numbers_(changing.numbers),
      apart_(changing.axes_alike ? D : 1),
      n_(static_cast<std::size_t>(numbers_) * count_, 0.0),
      change_(program.padded, 0.0),
      given_(first_, 0.0) {
  panels.start();
  accepted_ = panels.factorize_and_solve(change_.data(), Part::constant);
  list_entries(constraints);
  if (program.inverts_points) {
    inverse_.emplace(first_, program.padded, changing.axes_alike,
                     [&](double* x) { solve_points(x); });
  }
  find_products();
}

template <int D>
void Schur<D>::list_entries(const Constraints<double, D>& constraints) {
  std::vector<int> of_row(count_);
  for (int k = 0; k < count_; ++k) of_row[constraints.row(k) - first_] = k;
  for (int m = 0; m < count_; ++m) {
    constraints.unit_entries(of_row[m], [&](int i, int row, double unit) {
      if (unit != 0.0) entries_.push_back({row, i * count_ + m, unit});
    });
    entries_end_.push_back(static_cast<int>(entries_.size()));
  }
  values_.resize(entries_.size());
}

template <int D>
std::vector<int> Schur<D>::rows_of(const Front& front) const {
  std::vector<int> rows(front.pivots);
  for (int i = 0; i < front.pivots; ++i) rows[i] = front.first + i;
  const auto* border = program_.border_rows.data() + front.rows;
  rows.insert(rows.end(), border, border + front.border);
  return rows;
}

template <int D>
void Schur<D>::find_products() {
  std::size_t longest = 0;
  for (std::size_t f = program_.constant_fronts; f < program_.fronts.size(); ++f) {
    const std::vector<int> rows = rows_of(program_.fronts[f]);
    longest = std::max(longest, rows.size());
    for (int j = 0; j < program_.fronts[f].pivots; ++j) {
      find_products_of_column(rows[j], rows, j / kPanel * kPanel);
    }
  }
  of_front_.resize(numbers_ * round_up(static_cast<int>(longest), L), 0.0);
}

/// Of the rows from the `above`-th on.
template <int D>
void Schur<D>::find_products_of_column(int column, std::span<const int> rows, int above) {
  const auto entries_of = [&](int row) {
    const int m = row - first_, begin = m == 0 ? 0 : entries_end_[m - 1];
    return std::span(entries_).subspan(begin, entries_end_[m] - begin);
  };
  const std::size_t base = products_.size();
  const int size = static_cast<int>(rows.size()), kinds = numbers_ / apart_;
  products_.resize(base + kinds * kinds * (round_up(size, L) - above), 0.0);
  for (int j = 0; j < kinds; ++j) {
    std::fill(change_.begin(), change_.end(), 0.0);
    for (const Entry& e : entries_of(column)) {
      if (e.number / count_ == j * apart_) change_[e.row] += e.unit;
    }
    solve_points(change_.data());
    for (int k = above; k < size; ++k) {
      double* to = products_.data() + base + (k - above) / L * L * kinds * kinds + k % L;
      for (const Entry& e : entries_of(rows[k])) {
        const int i = e.number / count_;
        if (i % apart_ == 0) to[(i / apart_ * kinds + j) * L] += e.unit * change_[e.row];
      }
    }
  }
}

// Assembly.

template <int D>
void Schur<D>::assemble(const Constraints<double, D>& constraints) {
  constraints.gradient_numbers(
      [&](int k, int i, double n) { n_[i * count_ + constraints.row(k) - first_] = n; });
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    values_[e] = entries_[e].unit * n_[entries_[e].number];
  }
  const bool alike = apart_ == D;
  if (numbers_ == D) return alike ? assemble_fronts<D, true>() : assemble_fronts<D, false>();
  alike ? assemble_fronts<2 * D, true>() : assemble_fronts<2 * D, false>();
}

template <int D>
template <int N, bool kAlike>
void Schur<D>::assemble_fronts() {
  const double* products = products_.data();
  for (std::size_t f = program_.constant_fronts; f < program_.fronts.size(); ++f) {
    const Front& front = program_.fronts[f];
    const int* border = program_.border_rows.data() + front.rows;
    const int rows = round_up(front.pivots + front.border, L);
    for (int i = 0; i < N; ++i) {
      const double* n = n_.data() + i * count_ - first_;
      double* to = of_front_.data() + i * rows;
      std::copy_n(n + front.first, front.pivots, to);
      for (int k = 0; k < front.border; ++k) to[front.pivots + k] = n[border[k]];
    }
    for (int j = 0; j < front.pivots; ++j) {
      products = assemble_column<N, kAlike>(front, j, rows, products);
    }
  }
}

/// Columns are written one after the other: rows of padding, where K is zero, may lie in the next.
template <int D>
template <int N, bool kAlike>
const double* Schur<D>::assemble_column(const Front& front, int j, int rows,
                                        const double* products) {
  constexpr int kApart = kAlike ? D : 1;
  const int diagonal = front.base + j * (front.stride + 1);
  double* column = panels_.matrix() + diagonal - j;
  const double* n = of_front_.data();
  double of_column[N];
  for (int i = 0; i < N; ++i) of_column[i] = -n[i * rows + j];
  for (int k = j / kPanel * kPanel; k < rows; k += L) {
    V sum = V{};
#pragma GCC unroll 6
    for (int i = 0; i < N; i += kApart) {
      V of_number = V{};
#pragma GCC unroll 6
      for (int l = 0; l < N; l += kApart, products += L) {
        if constexpr (kAlike) {  // n_k · n_l
          V factor = load<double, L>(n + i * rows + k) * of_column[l];
#pragma GCC unroll 3
          for (int x = 1; x < D; ++x) {
            factor += load<double, L>(n + (i + x) * rows + k) * of_column[l + x];
          }
          of_number += load<double, L>(products) * factor;
        } else {
          of_number += load<double, L>(products) * of_column[l];
        }
      }
      sum += kAlike ? of_number : load<double, L>(n + i * rows + k) * of_number;
    }
    store<double, L>(column + k, sum);
  }
  panels_.matrix()[diagonal] += panels_.constants()[diagonal];
  return products;
}

// Solves.

template <int D>
void Schur<D>::solve_points(double* x) {
  if (!inverse_) return panels_.solve(x, Part::constant);
  std::copy_n(x, first_, given_.data());
  std::fill_n(x, first_, 0.0);
  inverse_->add_product(given_.data(), x);
}

template <int D>
bool Schur<D>::factorize_and_solve(double* y, Points points) {
  eliminate_points(y, points);
  const bool accepted = panels_.factorize_and_solve(y, Part::changing);
  add_forces(y);
  return accepted && accepted_;
}

template <int D>
void Schur<D>::solve(double* y, Points points) {
  eliminate_points(y, points);
  panels_.solve(y, Part::changing);
  add_forces(y);
}

/// x = A⁻¹ r, and Φq x is subtracted from the multipliers' rows. Nothing where r is zero, as in
/// projections.
template <int D>
void Schur<D>::eliminate_points(double* y, Points points) {
  if (std::all_of(y, y + first_, [](double x) { return x == 0.0; })) return;
  if (points == Points::given) solve_points(y);
  std::size_t e = 0;
  for (int m = 0; m < count_; ++m) {
    double sum = 0.0;
    for (; e < static_cast<std::size_t>(entries_end_[m]); ++e)
      sum += values_[e] * y[entries_[e].row];
    y[first_ + m] -= sum;
  }
}

/// x −= A⁻¹ Φqᵀ μ.
template <int D>
void Schur<D>::add_forces(double* y) {
  std::fill_n(change_.begin(), first_, 0.0);
  std::size_t e = 0;
  for (int m = 0; m < count_; ++m) {
    const double mu = y[first_ + m];
    for (; e < static_cast<std::size_t>(entries_end_[m]); ++e) {
      change_[entries_[e].row] -= values_[e] * mu;
    }
  }
  if (inverse_) return inverse_->add_product(change_.data(), y);
  panels_.solve(change_.data(), Part::constant);
  for (int i = 0; i < first_; ++i) y[i] += change_[i];
}

// These are compiled once, beside the steps.
extern template class Schur<2>;
extern template class Schur<3>;

}  // namespace mbs::compiled_ldl
