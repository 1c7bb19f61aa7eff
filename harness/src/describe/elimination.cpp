// Elimination tree and column counts by walking the row subtrees [Davis, 2006, 4.1 and 4.4].
#include "describe/elimination.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

#include "scene/tangent_pattern.hpp"

namespace mbs {
namespace {

using nlohmann::json;
using Index = std::size_t;

Index at(int index) { return static_cast<Index>(index); }

json elimination_json(const std::optional<Elimination>& found) {
  if (!found) return nullptr;
  return {{"factor_nonzeros", found->factor_nonzeros},
          {"flops", found->flops},
          {"height", found->height},
          {"widest", found->widest}};
}

/// `below[j]` is the number of non-zeros of column j of L below its diagonal.
Elimination summed(const std::vector<int>& parent, const std::vector<int>& below) {
  Elimination result;
  std::vector<int> height(parent.size(), 1);  // of the subtree of a column: parents come later
  for (Index j = 0; j < parent.size(); ++j) {
    const int count = below[j] + 1;
    result.factor_nonzeros += count;
    result.flops += static_cast<double>(count) * count;
    result.widest = std::max(result.widest, count);
    result.height = std::max(result.height, height[j]);
    if (parent[j] < 0) continue;
    int& above = height[at(parent[j])];
    above = std::max(above, height[j] + 1);
  }
  return result;
}

}  // namespace

SymmetricPattern::SymmetricPattern(int size, const std::vector<std::pair<int, int>>& pairs)
    : start(at(size) + 1, 0), rows(2 * pairs.size()) {
  for (const auto& [row, col] : pairs) {
    ++start[at(row) + 1];
    ++start[at(col) + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (const auto& [row, col] : pairs) {
    rows[at(next[at(row)]++)] = col;
    rows[at(next[at(col)]++)] = row;
  }
}

SymmetricPattern tangent_pattern(const Model& model) {
  TangentPattern pattern(model);
  std::vector<std::pair<int, int>> pairs;
  for (int col = 0; col < model.variables(); ++col) {
    for (const int row : pattern.below(col)) pairs.emplace_back(row, col);
  }
  return {model.variables(), pairs};
}

std::optional<Elimination> eliminate(const SymmetricPattern& pattern,
                                     const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (Index k = 0; k < order.size(); ++k) place[at(order[k])] = static_cast<int>(k);
  std::vector<int> parent(order.size(), -1), below(order.size(), 0), seen_in(order.size(), -1);
  long nonzeros = 0;
  for (int row = 0; row < pattern.size(); ++row) {
    // Row `row` of L is non-zero on the paths in the tree from its entries of T up to the row.
    seen_in[at(row)] = row;
    const int given = order[at(row)];
    for (int k = pattern.start[at(given)]; k < pattern.start[at(given) + 1]; ++k) {
      int col = place[at(pattern.rows[at(k)])];
      if (col > row) continue;
      for (; seen_in[at(col)] != row; col = parent[at(col)]) {
        if (parent[at(col)] < 0) parent[at(col)] = row;
        ++below[at(col)];
        ++nonzeros;
        seen_in[at(col)] = row;
      }
    }
    if (nonzeros + row + 1 > kMostFactorNonzeros) return std::nullopt;
  }
  return summed(parent, below);
}

std::vector<int> natural_order(const SymmetricPattern& pattern) {
  std::vector<int> order(at(pattern.size()));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<int> amd_order(const SymmetricPattern& pattern) {
  const int size = pattern.size();
  Eigen::SparseMatrix<char> matrix(size, size);  // AMD reads no values
  matrix.resizeNonZeros(size + static_cast<Eigen::Index>(pattern.rows.size()));
  matrix.coeffs().setOnes();
  int* entry = matrix.innerIndexPtr();
  for (int col = 0; col < size; ++col) {
    *entry++ = col;  // Eigen puts columns without a diagonal last, untouched
    const auto rows = pattern.rows.begin();
    entry = std::copy(rows + pattern.start[at(col)], rows + pattern.start[at(col) + 1], entry);
    matrix.outerIndexPtr()[col + 1] = static_cast<int>(entry - matrix.innerIndexPtr());
  }
  Eigen::AMDOrdering<int>::PermutationType permutation;
  Eigen::AMDOrdering<int>()(matrix.selfadjointView<Eigen::Lower>(), permutation);
  return {permutation.indices().data(), permutation.indices().data() + size};
}

json elimination_json(const SymmetricPattern& pattern) {
  const auto natural = eliminate(pattern, natural_order(pattern));
  const auto amd = eliminate(pattern, amd_order(pattern));
  json result = {
      {"ordering", "AMD"},
      {"orderings", {{"natural", elimination_json(natural)}, {"AMD", elimination_json(amd)}}}};
  for (const char* key : {"factor_nonzeros", "per_column", "flops", "height", "widest"}) {
    result[key] = nullptr;
  }
  if (amd) {
    result.update(result["orderings"]["AMD"]);
    result["per_column"] = static_cast<double>(amd->factor_nonzeros) / std::max(1, pattern.size());
  }
  return result;
}

}  // namespace mbs
