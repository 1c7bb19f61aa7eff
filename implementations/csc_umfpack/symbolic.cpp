// Set-up: the schedules of the rank-k update and of the elements.
#include "symbolic.hpp"

#include <algorithm>
#include <numeric>

namespace mbs::csc_umfpack {
namespace {

/// The sets of coordinates that T couples: those of every row of Phi_q and of every element.
Lists coupled_coordinates(const JacobianLayout& layout, const ForceLayout& forces, int dimension) {
  Lists sets = row_coordinates(layout, dimension);
  add_element_coordinates(forces, dimension, sets);
  return sets;
}

/// One product of the rank-k update: where in T, and of which blocks of Phi_q.
struct Product {
  static constexpr int kNone = -1;  ///< an element reaches this block of T, without a product

  int col = 0, row = 0;  ///< first coordinates
  int row_block = kNone, col_block = kNone;

  [[nodiscard]] bool same_block(const Product& other) const {
    return col == other.col && row == other.row;
  }
};

/// Sorts by a key from 0 to `keys` - 1 in linear time; equal ones keep their order.
template <class Key>
void counting_sort(std::vector<Product>& products, int keys, Key key) {
  std::vector<int> starts(keys + 1, 0);
  for (const Product& product : products) ++starts[key(product) + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Product> sorted(products.size());
  for (const Product& product : products) sorted[starts[key(product)]++] = product;
  products.swap(sorted);
}

/// The products that the lower triangle of T is made of, diagonal blocks of T first, then by
/// column.
std::vector<Product> products(const std::vector<JacobianLayout::Block>& blocks,
                              const ForceLayout& forces, int variables) {
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
  for (const auto& element : elements(forces)) {
    for (const auto& row : element) {
      for (const auto& col : element) {
        if (row.offset >= col.offset) result.push_back({col.offset, row.offset});
      }
    }
  }
  counting_sort(result, variables, [](const Product& product) { return product.row; });
  counting_sort(result, variables, [](const Product& product) { return product.col; });
  counting_sort(result, 2, [](const Product& product) { return product.row != product.col; });
  return result;
}

}  // namespace

template <int D>
TangentSchedule<D>::TangentSchedule(const SparsityPattern& mass, const JacobianLayout& layout,
                                    const ForceLayout& forces)
    : pattern(union_pattern(mass, coupled_coordinates(layout, forces, D))),
      places(element_places<D>(pattern, forces)) {
  Product last{-1, -1};
  for (const Product& product : products(layout.blocks, forces, mass.variables())) {
    std::vector<Block>& kind = product.row == product.col ? diagonal : lower;
    if (!product.same_block(last)) {
      const int first = static_cast<int>(pairs.size());
      kind.push_back({first, first, {pattern, product.row, product.col}});
      last = product;
    }
    if (product.row_block == Product::kNone) continue;
    pairs.push_back({product.row_block, product.col_block});
    kind.back().last = static_cast<int>(pairs.size());
  }
}

template struct TangentSchedule<2>;
template struct TangentSchedule<3>;

}  // namespace mbs::csc_umfpack
