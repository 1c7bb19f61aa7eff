// Where the tangent (5) can be non-zero, column by column.
#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// Which matrix a pattern is of.
enum class PatternOf {
  tangent,       ///< M + C + K + Phi_q^T Phi_q
  leading_block  ///< M + C + K, which the saddle-point matrix (12) has there
};

/// Pattern of such a matrix without storing it: memory is that of M and Phi_q, and a
/// column costs the sizes of the cliques that touch it. A clique is a set of coordinates that are
/// all coupled: those of a constraint, a spring or a torsion spring. The diagonal is always in the
/// pattern.
///
/// Example: the pendulum (A fixed, B free, one rod) has n = 2 and below(0) = {1}, below(1) = {}.
class TangentPattern {
 public:
  /// `model` must outlive the pattern.
  explicit TangentPattern(const Model& model, PatternOf which = PatternOf::tangent);

  /// Rows of the non-zeros below the diagonal of column `col`, unsorted; valid until the next call.
  std::span<const int> below(int col);

 private:
  void collect(int col, int row);
  void add_points(const Model& model, std::initializer_list<int> points);
  void read_constraints(const Model& model);
  void read_forces(const Model& model);

  std::span<const MassEntry> mass_;
  std::vector<std::size_t> mass_start_;    // of column j in mass_
  std::vector<std::size_t> clique_start_;  // of clique i in clique_columns_
  std::vector<int> clique_columns_;
  std::vector<std::size_t> column_start_;  // of column j in column_cliques_
  std::vector<int> column_cliques_;
  std::vector<int> seen_in_;  // last column whose pattern held this row
  std::vector<int> rows_;
};

}  // namespace mbs
