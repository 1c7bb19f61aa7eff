// What factorizing the tangent (5) takes, from its pattern alone.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// Counts stop at this many non-zeros of L, whose number their time is proportional to.
inline constexpr long kMostFactorNonzeros = 50'000'000;

/// Where a symmetric matrix is non-zero beside its diagonal: the rows of column j are
/// rows[start[j]] ... rows[start[j + 1] - 1], unsorted, above and below the diagonal.
///
/// Example: the 3 x 3 matrix with (1, 0) and (2, 0) has start {0, 2, 3, 4}, rows {1, 2, 0, 0}.
struct SymmetricPattern {
  /// Of `size` columns, from pairs (row, column) of different indices, each given once.
  SymmetricPattern(int size, const std::vector<std::pair<int, int>>& pairs);

  [[nodiscard]] int size() const { return static_cast<int>(start.size()) - 1; }

  std::vector<int> start, rows;
};

/// Pattern of the tangent, as tangent_nonzeros() counts it.
SymmetricPattern tangent_pattern(const Model& model);
/// Of the saddle-point matrix (12): n variables, then m rows of constraints.
SymmetricPattern saddle_point_pattern(const Model& model);

/// c_j is the number of non-zeros of column j of L, its diagonal included.
struct Elimination {
  long factor_nonzeros = 0;  ///< sum of c_j
  double flops = 0.0;        ///< sum of c_j^2
  int height = 0;            ///< of the elimination tree: columns on its longest path
  int widest = 0;            ///< largest c_j
  double per_column = 0.0;   ///< mean c_j
  int supernodes = 0;        ///< chains of columns, each with the rows of the one before less one
};

/// Of the pivots order[0], order[1], ...; none beyond kMostFactorNonzeros. Takes a time that is
/// proportional to the non-zeros of pattern and L.
std::optional<Elimination> eliminate(const SymmetricPattern& pattern,
                                     const std::vector<int>& order);

/// Flops of an L of n columns without zeros.
constexpr double full_flops(double n) { return n * (n + 1) * (2 * n + 1) / 6; }
/// Flops of a dense solver of the saddle-point form: S = Phi_q T0^-1 Phi_q^T and its factor; where
/// springs change T0, its factor and the rows of Phi_q solved with it.
constexpr double dense_saddle_flops(double n, double m, bool has_springs) {
  return n * m * m + full_flops(m) + (has_springs ? full_flops(n) + n * n * m : 0.0);
}

/// 0, 1, 2, ...
std::vector<int> natural_order(const SymmetricPattern& pattern);
/// Approximate minimum degree [Amestoy, Davis, Duff, 1996].
std::vector<int> amd_order(const SymmetricPattern& pattern);
/// The same of the columns for any choice of pivots [Davis, Gilbert, Larimore, Ng, 2004], which
/// knows nothing of symmetry: that of the product with the transpose.
std::vector<int> colamd_order(const SymmetricPattern& pattern);
/// Nested dissection [Karypis, Kumar, 1998]; std::bad_alloc where its memory does not suffice.
std::vector<int> metis_order(const SymmetricPattern& pattern);

/// By constraint: of a linear one the coordinate with the largest coefficient of those that no
/// other linear one has, unless that is far below its largest. It is a substitution for that
/// coordinate. Of another one those of a point that no other constraint has, unless it is far
/// heavier than the constraint's others. Empty where there is none.
std::vector<std::vector<int>> owned_coordinates(const Model& model);

/// `order` of the first unknowns of `pattern`, and each of the others, the rows, right after the
/// last of those that it is coupled with: so the sparse implementations order the saddle-point
/// matrix (12). A row that owns unknowns (owned[row]) comes right after the last of these. Rows
/// that are coupled with an owned one wait for what its owner is coupled with, too.
std::vector<int> rows_behind(const std::vector<int>& order, const SymmetricPattern& pattern,
                             const std::vector<std::vector<int>>& owned);

/// Of the patterns of tangent and saddle-point matrix, and owned_coordinates(). Keys: ordering
/// ("AMD"), whose factor_nonzeros, per_column (non-zeros of L a column), flops, height, widest and
/// supernodes follow, null if not computed; orderings {"natural", "AMD", "COLAMD", "METIS",
/// "saddle-point"}: the same keys each, or null; the last is of the saddle-point matrix.
nlohmann::json elimination_json(const SymmetricPattern& tangent,
                                const SymmetricPattern& saddle_point,
                                const std::vector<std::vector<int>>& owned);

}  // namespace mbs
