// Elimination tree and column counts by walking the row subtrees [Davis, 2006, 4.1 and 4.4].
#include "describe/elimination.hpp"

#include <metis.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <span>

#include "model_math/kinematics.hpp"
#include "scene/tangent_pattern.hpp"

namespace mbs {
namespace {

using nlohmann::json;
using Index = std::size_t;

constexpr double kMuchLess = 1e-3;

Index at(int index) { return static_cast<Index>(index); }

json elimination_json(const std::optional<Elimination>& found) {
  if (!found) return nullptr;
  return {{"factor_nonzeros", found->factor_nonzeros},
          {"per_column", found->per_column},
          {"flops", found->flops},
          {"height", found->height},
          {"widest", found->widest},
          {"supernodes", found->supernodes}};
}

/// `below[j]` is the number of non-zeros of column j of L below its diagonal.
Elimination summed(const std::vector<int>& parent, const std::vector<int>& below) {
  Elimination result;
  std::vector<int> height(parent.size(), 1);  // of the subtree of a column: parents come later
  std::vector<char> goes_on(parent.size(), false);  // whether a column goes on with a child's rows
  for (Index j = 0; j < parent.size(); ++j) {
    const int count = below[j] + 1;
    result.factor_nonzeros += count;
    result.flops += static_cast<double>(count) * count;
    result.widest = std::max(result.widest, count);
    result.height = std::max(result.height, height[j]);
    result.supernodes += goes_on[j] ? 0 : 1;
    if (parent[j] < 0) continue;
    const Index next = at(parent[j]);
    height[next] = std::max(height[next], height[j] + 1);
    if (below[j] == below[next] + 1) goes_on[next] = true;
  }
  const auto columns = static_cast<double>(std::max<Index>(1, parent.size()));
  result.per_column = static_cast<double>(result.factor_nonzeros) / columns;
  return result;
}

std::vector<std::pair<int, int>> pairs_of(const Model& model, PatternOf which) {
  TangentPattern pattern(model, which);
  std::vector<std::pair<int, int>> pairs;
  for (int col = 0; col < model.variables(); ++col) {
    for (const int row : pattern.below(col)) pairs.emplace_back(row, col);
  }
  return pairs;
}

/// By quadratic constraint: the coordinates of a point that no other has, and no linear one
/// (`linear_with`, by coordinate), unless it is far heavier than the others of the constraint.
std::vector<std::vector<int>> owned_points(const Model& model,
                                           const std::vector<int>& linear_with) {
  const std::vector<double> mass = mass_diagonal(model);
  std::vector<std::vector<int>> starts, owned;  // starts: of a constraint's free points
  std::vector<int> with(at(model.variables()), 0);
  const auto add = [&](const auto& c) {
    starts.emplace_back();
    for (const int p : {c.a, c.b, c.c, c.d}) {
      const int start = model.points()[at(p)].offset;
      if (start < 0 || std::ranges::find(starts.back(), start) != starts.back().end()) continue;
      starts.back().push_back(start);
      ++with[at(start)];
    }
  };
  std::ranges::for_each(model.dot_constraints(), add);
  std::ranges::for_each(model.bilinear_constraints(), add);
  for (const std::vector<int>& points : starts) {
    owned.emplace_back();
    double lightest = std::numeric_limits<double>::infinity();
    for (const int start : points) lightest = std::min(lightest, mass[at(start)]);
    for (const int start : points) {
      std::vector<int> coordinates(at(model.dimension()));
      std::iota(coordinates.begin(), coordinates.end(), start);
      const auto is_free = [&](int i) { return linear_with[at(i)] == 0; };
      if (with[at(start)] == 1 && std::ranges::all_of(coordinates, is_free) &&
          kMuchLess * mass[at(start)] <= lightest) {
        owned.back() = coordinates;
      }
    }
  }
  return owned;
}

/// With ones; orderings read no values.
Eigen::SparseMatrix<char> matrix_of(const SymmetricPattern& pattern) {
  const int size = pattern.size();
  Eigen::SparseMatrix<char> matrix(size, size);
  matrix.resizeNonZeros(size + static_cast<Eigen::Index>(pattern.rows.size()));
  matrix.coeffs().setOnes();
  int* entry = matrix.innerIndexPtr();
  for (int col = 0; col < size; ++col) {
    *entry++ = col;  // Eigen's AMD puts columns without a diagonal last, untouched
    const auto rows = pattern.rows.begin();
    entry = std::copy(rows + pattern.start[at(col)], rows + pattern.start[at(col) + 1], entry);
    matrix.outerIndexPtr()[col + 1] = static_cast<int>(entry - matrix.innerIndexPtr());
  }
  return matrix;
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
  return {model.variables(), pairs_of(model, PatternOf::tangent)};
}

SymmetricPattern saddle_point_pattern(const Model& model) {
  const int n = model.variables();
  auto pairs = pairs_of(model, PatternOf::leading_block);
  for (const JacobianEntry& entry : jacobian(model, 0.0, model.initial_position())) {
    pairs.emplace_back(n + entry.row, entry.col);
  }
  return {n + model.constraints(), pairs};
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
  Eigen::AMDOrdering<int>::PermutationType permutation;
  Eigen::AMDOrdering<int>()(matrix_of(pattern).selfadjointView<Eigen::Lower>(), permutation);
  return {permutation.indices().data(), permutation.indices().data() + pattern.size()};
}

std::vector<int> colamd_order(const SymmetricPattern& pattern) {
  if (pattern.size() == 0) return {};
  Eigen::COLAMDOrdering<int>::PermutationType place;  // of each column
  Eigen::COLAMDOrdering<int>()(matrix_of(pattern), place);
  std::vector<int> order(at(pattern.size()));
  for (int col = 0; col < pattern.size(); ++col) order[at(place.indices()[col])] = col;
  return order;
}

std::vector<int> metis_order(const SymmetricPattern& pattern) {
  if (pattern.rows.empty()) return natural_order(pattern);  // METIS wants edges
  idx_t size = pattern.size();
  std::vector<idx_t> start(pattern.start.begin(), pattern.start.end());
  std::vector<idx_t> rows(pattern.rows.begin(), pattern.rows.end());
  std::vector<idx_t> order(at(size)), place(at(size));
  if (METIS_NodeND(&size, start.data(), rows.data(), nullptr, nullptr, order.data(),
                   place.data()) != METIS_OK) {
    throw std::bad_alloc();
  }
  return {order.begin(), order.end()};
}

std::vector<std::vector<int>> owned_coordinates(const Model& model) {
  std::vector<int> rows_with(at(model.variables()), 0);
  for (const LinearConstraint& linear : model.linear_constraints()) {
    for (const LinearConstraint::Term& term : linear.terms) ++rows_with[at(term.coordinate)];
  }
  std::vector<std::vector<int>> owned = owned_points(model, rows_with);
  for (const LinearConstraint& linear : model.linear_constraints()) {
    double largest = 0.0, most = 0.0;
    int found = -1;
    for (const auto& [coordinate, coefficient] : linear.terms) {
      largest = std::max(largest, std::abs(coefficient));
      if (rows_with[at(coordinate)] > 1 || std::abs(coefficient) <= most) continue;
      most = std::abs(coefficient);
      found = coordinate;
    }
    owned.emplace_back();
    if (most > kMuchLess * largest) owned.back() = {found};
  }
  return owned;
}

std::vector<int> rows_behind(const std::vector<int>& order, const SymmetricPattern& pattern,
                             const std::vector<std::vector<int>>& owned) {
  const Index variables = order.size(), size = at(pattern.size());
  std::vector<std::size_t> place(variables);
  for (Index k = 0; k < variables; ++k) place[at(order[k])] = k + 1;
  std::vector<Index> last(size - variables, 0);  // of a row: as many variables before it, by itself
  std::vector<int> owner(variables, -1);
  const auto neighbours = [&pattern](Index unknown) {
    const auto rows = pattern.rows.begin();
    return std::span(rows + pattern.start[unknown], rows + pattern.start[unknown + 1]);
  };
  for (Index row = 0; row < last.size(); ++row) {
    for (const int i : owned[row]) owner[at(i)] = static_cast<int>(row);
    for (const int i : neighbours(variables + row)) last[row] = std::max(last[row], place[at(i)]);
  }
  std::vector<std::vector<int>> after(variables + 1);  // rows, by the variables before them
  for (Index row = 0; row < last.size(); ++row) {
    Index behind = last[row];
    for (const int i : neighbours(variables + row)) {
      if (owner[at(i)] >= 0) behind = std::max(behind, last[at(owner[at(i)])]);
    }
    if (!owned[row].empty()) behind = 0;
    for (const int i : owned[row]) behind = std::max(behind, place[at(i)]);
    after[behind].push_back(static_cast<int>(variables + row));
  }
  std::vector<int> result = after[0];
  for (Index k = 0; k < variables; ++k) {
    result.push_back(order[k]);
    result.insert(result.end(), after[k + 1].begin(), after[k + 1].end());
  }
  return result;
}

json elimination_json(const SymmetricPattern& tangent, const SymmetricPattern& saddle_point,
                      const std::vector<std::vector<int>>& owned) {
  const std::vector<int> order = amd_order(tangent);
  const auto natural = eliminate(tangent, natural_order(tangent));
  const auto amd = eliminate(tangent, order);
  const auto colamd = eliminate(tangent, colamd_order(tangent));
  const auto metis = eliminate(tangent, metis_order(tangent));
  const auto rows = eliminate(saddle_point, rows_behind(order, saddle_point, owned));
  json result = {{"ordering", "AMD"},
                 {"orderings",
                  {{"natural", elimination_json(natural)},
                   {"AMD", elimination_json(amd)},
                   {"COLAMD", elimination_json(colamd)},
                   {"METIS", elimination_json(metis)},
                   {"saddle-point", elimination_json(rows)}}}};
  for (const char* key :
       {"factor_nonzeros", "per_column", "flops", "height", "widest", "supernodes"}) {
    result[key] = nullptr;
  }
  if (amd) result.update(result["orderings"]["AMD"]);
  return result;
}

}  // namespace mbs
