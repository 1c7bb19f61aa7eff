// Set-up: patterns, the lowered constraints, and the schedule of the rank-k update.
#include "symbolic.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace mbs::csc_umfpack {
namespace {

/// Lists of integers, one after the other: list r is items[starts[r]] ... items[starts[r + 1] - 1].
struct Lists {
  std::vector<int> starts{0};
  std::vector<int> items;

  [[nodiscard]] int count() const { return static_cast<int>(starts.size()) - 1; }
  [[nodiscard]] std::span<const int> operator[](int r) const {
    return std::span(items).subspan(starts[r], starts[r + 1] - starts[r]);
  }
  void end_list() { starts.push_back(static_cast<int>(items.size())); }
};

/// The coordinates of every row of Phi_q.
Lists row_coordinates(const JacobianLayout& layout, int dimension) {
  Lists rows;
  const int dot_rows = static_cast<int>(layout.order.size() - layout.linears.size());
  auto block = layout.blocks.begin();
  for (int row = 0; row < dot_rows; ++row, rows.end_list()) {
    for (; block != layout.blocks.end() && block->row == row; ++block) {
      for (int k = 0; k < dimension; ++k) rows.items.push_back(block->offset + k);
    }
  }
  for (const auto& linear : layout.linears) {
    for (int t = linear.first; t < linear.last; ++t) {
      rows.items.push_back(layout.terms[t].coordinate);
    }
    rows.end_list();
  }
  return rows;
}

/// For every number below `n`, the lists that it is in.
Lists transpose(const Lists& lists, int n) {
  Lists result;
  result.starts.assign(n + 1, 0);
  result.items.resize(lists.items.size());
  for (const int item : lists.items) ++result.starts[item + 1];
  std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
  std::vector<int> next(result.starts.begin(), result.starts.end() - 1);
  for (int r = 0; r < lists.count(); ++r) {
    for (const int item : lists[r]) result.items[next[item]++] = r;
  }
  return result;
}

/// The pattern of M + Phi_q^T Phi_q.
SparsityPattern union_pattern(const SparsityPattern& mass, const Lists& rows) {
  const int n = mass.variables();
  const Lists incident = transpose(rows, n);
  SparsityPattern result;
  result.starts.push_back(0);
  std::vector<int> seen_in(n, -1);  // the last column that a row index was put into
  for (int col = 0; col < n; ++col) {
    const auto add = [&](int row) {
      if (seen_in[row] == col) return;
      seen_in[row] = col;
      result.rows.push_back(row);
    };
    for (int k = mass.starts[col]; k < mass.starts[col + 1]; ++k) add(mass.rows[k]);
    for (const int r : incident[col]) std::ranges::for_each(rows[r], add);
    std::sort(result.rows.begin() + result.starts.back(), result.rows.end());
    result.starts.push_back(static_cast<int>(result.rows.size()));
  }
  return result;
}

/// One product of the rank-k update: where in T, and of which blocks of Phi_q.
struct Product {
  int col, row;  ///< first coordinates
  int row_block, col_block;

  /// Diagonal blocks of T first, then by column.
  [[nodiscard]] auto key() const { return std::tuple(row != col, col, row); }
};

/// The products that the lower triangle of T is made of, in the order of their keys.
std::vector<Product> products(const std::vector<JacobianLayout::Block>& blocks) {
  std::vector<Product> result;
  const int count = static_cast<int>(blocks.size());
  for (int first = 0, last = 0; first < count; first = last) {
    while (last < count && blocks[last].row == blocks[first].row) ++last;
    for (int i = first; i < last; ++i) {
      for (int j = first; j < last; ++j) {
        if (blocks[i].offset < blocks[j].offset) continue;
        result.push_back({blocks[j].offset, blocks[i].offset, i, j});
      }
    }
  }
  std::ranges::stable_sort(result, {}, &Product::key);
  return result;
}

}  // namespace

int SparsityPattern::position(int row, int col) const {
  const auto first = rows.begin() + starts[col], last = rows.begin() + starts[col + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - rows.begin());
}

SparsityPattern mass_pattern(const Model& model) {
  SparsityPattern result;
  result.starts.assign(model.variables() + 1, 0);
  for (const auto& entry : model.mass()) {
    ++result.starts[entry.col + 1];
    if (entry.row != entry.col) ++result.starts[entry.row + 1];
  }
  std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
  result.rows.resize(result.starts.back());
  std::vector<int> next(result.starts.begin(), result.starts.end() - 1);
  // The Model sorts by column, so what a column has above its diagonal arrives first, and in order.
  for (const auto& entry : model.mass()) {
    result.rows[next[entry.col]++] = entry.row;
    if (entry.row != entry.col) result.rows[next[entry.row]++] = entry.col;
  }
  return result;
}

JacobianLayout::JacobianLayout(const Model& model) : variables(model.variables()) {
  add_points(model);
  const auto constraints = model.dot_constraints();
  std::vector<int> link_order, dot_order;  // `order` starts with the pins
  for (int k = 0; k < static_cast<int>(constraints.size()); ++k) {
    const DotConstraint& dot = constraints[k];
    const auto [a, b] = std::minmax(offsets_[dot.a], offsets_[dot.b]);  // free before fixed
    if (dot.a != dot.c || dot.b != dot.d || a == b || a >= variables) {
      dot_order.push_back(k);
    } else if (b >= variables) {
      order.push_back(k);
      pins.push_back({a, b, dot.value});
    } else {
      link_order.push_back(k);
      links.push_back({a, b, dot.value});
    }
  }
  int row = 0;
  for (const Distance& pin : pins) blocks.push_back({pin.a, row++});
  for (const Distance& link : links) {
    blocks.push_back({link.a, row});
    blocks.push_back({link.b, row++});
  }
  order.insert(order.end(), link_order.begin(), link_order.end());
  order.insert(order.end(), dot_order.begin(), dot_order.end());
  for (const int k : dot_order) add_dot(constraints[k]);
  for (const LinearConstraint& linear : model.linear_constraints()) add_linear(linear);
}

void JacobianLayout::add_points(const Model& model) {
  for (const Point& point : model.points()) {
    const int next_fixed = variables + static_cast<int>(fixed.size());
    offsets_.push_back(point.is_fixed() ? next_fixed : point.offset);
    if (!point.is_fixed()) continue;
    fixed.insert(fixed.end(), point.position.begin(), point.position.begin() + model.dimension());
  }
}

void JacobianLayout::add_dot(const DotConstraint& dot) {
  const int row = static_cast<int>(pins.size() + links.size() + dots.size());
  const int first = static_cast<int>(blocks.size());
  const auto add = [&](int point, Signs signs) {
    if (offsets_[point] >= variables) return;  // a fixed point has no columns
    for (std::size_t k = first; k < blocks.size(); ++k) {
      if (blocks[k].offset != offsets_[point]) continue;
      Signs& sum = dot_signs[dot_signs.size() - (blocks.size() - k)];
      sum = {sum.of_cd + signs.of_cd, sum.of_ab + signs.of_ab};
      return;
    }
    blocks.push_back({offsets_[point], row});
    dot_signs.push_back(signs);
  };
  add(dot.a, {1.0, 0.0});
  add(dot.b, {-1.0, 0.0});
  add(dot.c, {0.0, 1.0});
  add(dot.d, {0.0, -1.0});
  dots.push_back({offsets_[dot.a], offsets_[dot.b], offsets_[dot.c], offsets_[dot.d], dot.value,
                  first, static_cast<int>(blocks.size())});
}

void JacobianLayout::add_linear(const LinearConstraint& linear) {
  const int first = static_cast<int>(terms.size());
  terms.insert(terms.end(), linear.terms.begin(), linear.terms.end());
  linears.push_back({first, static_cast<int>(terms.size()), linear.value});
  order.push_back(static_cast<int>(order.size()));  // after the dot constraints, as in the Model
}

template <int D>
TangentSchedule<D>::TangentSchedule(const SparsityPattern& mass, const JacobianLayout& layout)
    : pattern(union_pattern(mass, row_coordinates(layout, D))) {
  auto last_key = std::tuple(false, -1, -1);
  for (const Product& product : products(layout.blocks)) {
    std::vector<Block>& kind = product.row == product.col ? diagonal : lower;
    if (product.key() != last_key) {
      Block& block = kind.emplace_back();
      block.first = static_cast<int>(pairs.size());
      for (int k = 0; k < D; ++k) {
        block.position[k] = pattern.position(product.row, product.col + k);
        block.mirrored[k] = pattern.position(product.col, product.row + k);
      }
      last_key = product.key();
    }
    pairs.push_back({product.row_block, product.col_block});
    kind.back().last = static_cast<int>(pairs.size());
  }
}

template struct TangentSchedule<2>;
template struct TangentSchedule<3>;

}  // namespace mbs::csc_umfpack
