// The constant mass matrix in blocks of a point: products and places in the fronts.
#pragma once

#include <map>
#include <utility>

#include "panels/vectors.hpp"
#include "scene.hpp"

namespace mbs::compiled_ldl {

/// As many numbers as a register holds, or one number of every simulation.
template <typename S>
auto load_rows(const S* x) {
  if constexpr (kLanesOf<S> == 1) {
    return load<S, kWidest<S>>(x);
  } else {
    return *x;
  }
}
template <typename S, typename V>
void store_rows(S* x, const V& v) {
  if constexpr (kLanesOf<S> == 1) {
    store<S, kWidest<S>>(x, v);
  } else {
    *x = v;
  }
}

/// y += s A x. Columns lie `stride` apart and are zero below the last row, up to a multiple of
/// eight rows. Eight columns at a time are read once for what they add below and, transposed, to
/// their own rows. A = [2 1; 1 3] is (2 1) and (· 3). With s = 1 and x = (1 2) its first column
/// adds 2 · 1 and 1 · 2 to y_0 and 1 · 1 to y_1, its second one 3 · 2 to y_1: (4 7).
template <typename F>
void add_symmetric_product(const F* a, int stride, int size, F s, const F* x, F* y) {
  constexpr int L = kWidest<F>, N = 8;
  using W = typename Short<F, L>::Type;
  int from = 0;
  for (; from + N <= size; from += N, a += N * stride) {
    F factor[N];
    W sums[N] = {};
#pragma GCC unroll 8
    for (int j = 0; j < N; ++j) factor[j] = s * x[from + j];
#pragma GCC unroll 4
    for (int i = 0; i < N; i += L) {  // on the diagonal
      const W x_i = load<F, L>(x + from + i);
      W y_i = load<F, L>(y + from + i);
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j) {
        const W column = load<F, L>(a + j * stride + from + i);
        y_i += first_lanes_or<F, L>(W{}, column, j - i) * factor[j];
        sums[j] += first_lanes_or<F, L>(W{}, column, j + 1 - i) * x_i;
      }
      store<F, L>(y + from + i, y_i);
    }
    for (int i = from + N; i < size; i += L) {
      const W x_i = load<F, L>(x + i);
      W y_i = load<F, L>(y + i);
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j) {
        const W column = load<F, L>(a + j * stride + i);
        y_i += column * factor[j];
        sums[j] += column * x_i;
      }
      store<F, L>(y + i, y_i);
    }
    store<F, N>(y + from, load<F, N>(y + from) + lane_sums<F>(sums) * s);
  }
  for (int j = from; j < size; ++j, a += stride) {
    y[j] += s * a[j] * x[j];
    for (int i = j + 1; i < size; ++i) {
      y[i] += s * a[i] * x[j];
      y[j] += s * a[i] * x[i];
    }
  }
}

/// Blocks that are multiples of the unit matrix, as rods and bodies in space have them, keep one
/// number. All else is in strips of rows, as many as a register holds, that keep their columns
/// where one of them is not zero: with two rows a strip, rows (1 2 0) and (2 5 0) are one strip
/// with columns 0 and 1, values 1, 2 and 2, 5. If strips have most of all columns, the lower half
/// is kept in their place.
template <typename S, int D>
class Mass {
 public:
  Mass(std::span<const Model* const> models, const Program& program, const Rows& rows);

  template <typename F>
  void add_to(F* matrix) const {
    for (const Entry& entry : entries_) matrix[entry.at] += static_cast<F>(entry.value);
  }
  /// y = M x.
  void product(const S* x, S* y) const {
    multiply(x, y, S(1.0), [](int /*row*/, const S& sum) { return sum; });
  }
  /// y = h (b − M x).
  void residual(const S* b, const S* x, const S& h, S* y) const {
    multiply(x, y, -h, [b, h](int row, const S& sum) { return h * (b[row] - sum); });
  }

 private:
  struct Entry {
    int at = 0;
    S value = {};
  };
  struct Row {
    int row = 0, multiples_end = 0;
  };
  struct Strip {
    int row = 0, columns_end = 0;
  };
  using Values = std::array<S, D * D>;
  struct Block {
    std::array<bool, D * D> stored{};
    Values values{};
  };

  static constexpr int kRows = kLanesOf<S> == 1 ? kWidest<S> : 1;
  static constexpr int kFew = 32;  // rows whose strips take no longer than the half
  /// By first row of a strip and column.
  using StripValues = std::map<std::pair<int, int>, std::array<S, kRows>>;

  static bool is_multiple(const Block& block);
  void add_strips(const StripValues& all);
  void add_half(const StripValues& all);
  template <typename First>
  void multiply(const S* x, S* y, const S& factor, First first) const;

  std::vector<Entry> entries_;
  std::vector<Row> rows_;
  std::vector<int> multiple_columns_, columns_;
  Array<S> multiples_, values_;  // kRows of each column
  std::vector<Strip> strips_;
  int size_ = 0;
  Array<S> half_;  // of M, as add_symmetric_product() takes it
};

template <typename S, int D>
Mass<S, D>::Mass(std::span<const Model* const> models, const Program& program, const Rows& rows) {
  std::map<std::pair<int, int>, Block> blocks;  // by row and column of the first coordinate
  const auto& all = models[0]->mass();
  std::vector<int> first(program.size);
  for (std::size_t i = 0; i < rows.of_point.size(); ++i) {
    if (!rows.is_free(rows.of_point[i])) continue;
    for (int x = 0; x < D; ++x) first[rows.of_point[i] + x] = rows.of_point[i];
  }
  for (int k = 0; k < static_cast<int>(all.size()); ++k) {
    const int i = rows.of_coordinate[all[k].row], j = rows.of_coordinate[all[k].col];
    const S value = of_models<S>(models, [&](const Model& m) { return m.mass()[k].value; });
    entries_.push_back({program.entry(std::max(i, j), std::min(i, j)), value});
    const auto put = [&](int row, int column) {
      Block& block = blocks[{first[row], first[column]}];
      const int at = (row - first[row]) * D + column - first[column];
      block.stored[at] = true;
      block.values[at] = value;
    };
    put(i, j);
    if (i != j) put(j, i);
  }
  StripValues others;
  for (const auto& [place, block] : blocks) {
    if (rows_.empty() || rows_.back().row != place.first) {
      Row row = rows_.empty() ? Row{} : rows_.back();
      row.row = place.first;
      rows_.push_back(row);
    }
    if (is_multiple(block)) {
      multiple_columns_.push_back(place.second);
      multiples_.push_back(block.values[0]);
      ++rows_.back().multiples_end;
      continue;
    }
    for (int i = 0; i < D * D; ++i) {
      if (!block.stored[i]) continue;
      const int row = place.first + i / D, column = place.second + i % D;
      auto& values = others[{row / kRows * kRows, column}];
      values[row % kRows] = block.values[i];
    }
  }
  size_ = program.size;
  const bool full = 2 * kRows * others.size() > static_cast<std::size_t>(size_) * size_;
  full&& kLanesOf<S> == 1 && size_ > kFew ? add_half(others) : add_strips(others);
}

template <typename S, int D>
void Mass<S, D>::add_strips(const StripValues& all) {
  for (const auto& [place, values] : all) {
    if (strips_.empty() || strips_.back().row != place.first) strips_.push_back({place.first, 0});
    columns_.push_back(place.second);
    values_.insert(values_.end(), values.begin(), values.end());
    strips_.back().columns_end = static_cast<int>(columns_.size());
  }
}

template <typename S, int D>
void Mass<S, D>::add_half(const StripValues& all) {
  const int stride = round_up(size_, 8);
  half_.resize(static_cast<std::size_t>(stride) * size_, S(0.0));
  for (const auto& [place, values] : all) {
    for (int i = 0; i < kRows; ++i) {
      const int row = place.first + i, column = place.second;
      if (row >= column && row < size_) half_[column * stride + row] = values[i];
    }
  }
}

template <typename S, int D>
bool Mass<S, D>::is_multiple(const Block& block) {
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < D; ++j) {
      if (block.stored[i * D + j] != (i == j)) return false;
      for (int l = 0; l < kLanesOf<S>; ++l) {
        if (i == j && lane(block.values[i * D + j], l) != lane(block.values[0], l)) return false;
      }
    }
  }
  return true;
}

/// y = first(row, M x of the multiples), then y += factor M x of the strips.
template <typename S, int D>
template <typename First>
void Mass<S, D>::multiply(const S* x, S* y, const S& factor, First first) const {
  int multiple = 0;
  for (const Row& row : rows_) {
    S sum[D];
    for (int i = 0; i < D; ++i) sum[i] = S(0.0);
    for (; multiple < row.multiples_end; ++multiple) {
      const S* xj = x + multiple_columns_[multiple];
      for (int i = 0; i < D; ++i) sum[i] += multiples_[multiple] * xj[i];
    }
    for (int i = 0; i < D; ++i) y[row.row + i] = first(row.row + i, sum[i]);
  }
  if constexpr (kLanesOf<S> == 1) {
    if (!half_.empty()) {
      return add_symmetric_product(half_.data(), round_up(size_, 8), size_, factor, x, y);
    }
  }
  int k = 0;
  const auto term = [&](int at) {
    return load_rows(values_.data() + at * kRows) * x[columns_[at]];
  };
  for (const Strip& strip : strips_) {
    auto sum = term(k++);
    auto more = sum * S(0.0);
    for (; k + 1 < strip.columns_end; k += 2) {
      sum += term(k);
      more += term(k + 1);
    }
    if (k < strip.columns_end) sum += term(k++);
    store_rows(y + strip.row, load_rows(y + strip.row) + (sum + more) * factor);
  }
}

// These are compiled once, beside the steps.
extern template class Mass<double, 2>;
extern template class Mass<double, 3>;
extern template class Mass<float, 2>;
extern template class Mass<float, 3>;

}  // namespace mbs::compiled_ldl
