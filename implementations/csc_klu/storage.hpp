// Compressed sparse columns: the pattern of a square matrix, and the constant mass matrix M.
#pragma once

#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_klu {

/// Pattern of a square matrix in compressed sparse columns, rows ascending within a column.
/// Example, [1 0; 2 3]: column_begin = {0, 2, 3}, row = {0, 1, 1}.
struct Pattern {
  struct Position {
    int row = 0, col = 0;
    bool operator==(const Position&) const = default;
  };

  Pattern() = default;
  /// The pattern of a `columns` x `columns` matrix; `positions` may come unsorted and repeatedly.
  Pattern(int columns, std::vector<Position> positions);

  [[nodiscard]] int columns() const { return static_cast<int>(column_begin.size()) - 1; }
  [[nodiscard]] int entries() const { return static_cast<int>(row.size()); }
  /// Offset of a stored position; a binary search, for set-up only.
  [[nodiscard]] int offset(int row, int col) const;

  std::vector<int> column_begin;  ///< columns + 1
  std::vector<int> row;           ///< entries
};

/// Positions of both triangles of M.
[[nodiscard]] std::vector<Pattern::Position> mass_positions(const Model& model);
/// M spread over `pattern`, which holds all positions of M; zero at the others (entries, kg).
[[nodiscard]] std::vector<double> mass_values(const Model& model, const Pattern& pattern);

/// The constant mass matrix M, both triangles, so that column i read as row i gives (M x)_i as one
/// sum. Stored zeros are entries like any other.
class MassMatrix {
 public:
  explicit MassMatrix(const Model& model);

  /// y = M x; both n.
  void multiply(const double* x, double* y) const;

 private:
  Pattern pattern_;
  std::vector<double> values_;
};

}  // namespace mbs::csc_klu
