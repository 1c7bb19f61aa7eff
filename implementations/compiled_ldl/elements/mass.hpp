// The constant mass matrix in blocks of a point: products and places in the fronts.
#pragma once

#include <map>
#include <utility>

#include "scene.hpp"

namespace mbs::compiled_ldl {

/// Blocks that are multiples of the unit matrix, as rods and bodies in space have them, keep one
/// number.
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
    multiply(x, y, [](int /*row*/, const S& sum) { return sum; });
  }
  /// y = h (b − M x).
  void residual(const S* b, const S* x, const S& h, S* y) const {
    multiply(x, y, [b, h](int row, const S& sum) { return h * (b[row] - sum); });
  }

 private:
  struct Entry {
    int at = 0;
    S value = {};
  };
  struct Row {
    int row = 0, multiples_end = 0, blocks_end = 0;
  };
  using Values = std::array<S, D * D>;
  struct Block {
    std::array<bool, D * D> stored{};
    Values values{};
  };

  static bool is_multiple(const Block& block);
  template <typename Finish>
  void multiply(const S* x, S* y, Finish finish) const;

  std::vector<Entry> entries_;
  std::vector<Row> rows_;
  std::vector<int> multiple_columns_, block_columns_;
  Array<S> multiples_, blocks_;
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
    } else {
      block_columns_.push_back(place.second);
      blocks_.insert(blocks_.end(), block.values.begin(), block.values.end());
      ++rows_.back().blocks_end;
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

template <typename S, int D>
template <typename Finish>
void Mass<S, D>::multiply(const S* x, S* y, Finish finish) const {
  int multiple = 0, block = 0;
  for (const Row& row : rows_) {
    S sum[D];
    for (int i = 0; i < D; ++i) sum[i] = S(0.0);
    for (; multiple < row.multiples_end; ++multiple) {
      const S* xj = x + multiple_columns_[multiple];
      for (int i = 0; i < D; ++i) sum[i] += multiples_[multiple] * xj[i];
    }
    for (; block < row.blocks_end; ++block) {
      const S* xj = x + block_columns_[block];
      const S* m = blocks_.data() + block * D * D;
      for (int j = 0; j < D; ++j) {
        for (int i = 0; i < D; ++i) sum[i] += m[i * D + j] * xj[j];
      }
    }
    for (int i = 0; i < D; ++i) y[row.row + i] = finish(row.row + i, sum[i]);
  }
}

}  // namespace mbs::compiled_ldl
