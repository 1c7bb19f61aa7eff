// The symbolic program: which dense fronts are eliminated in which order, and where numbers lie.
#pragma once

#include <vector>

namespace mbs::compiled_ldl {

/// Pivots that are eliminated at once, at most.
inline constexpr int kPanel = 8;

inline int round_up(int x, int unit) { return (x + unit - 1) / unit * unit; }

/// What couples with what. A node is a point (all its coordinates) or a multiplier (one row). Three
/// planar points of 1 kg in a row with rods 0 - 1 and 1 - 2: cliques are {0, 0}, {0, 0}, {1, 1}, …
/// of the entries of M, constant = 6, then {0, 1} and {1, 2}. In the saddle-point forms these two
/// are the borders of the multipliers, and solved = {0, 2}: no other row has these points.
struct Pattern {
  int dimension = 2;
  int points = 0;                         ///< nodes 0 … points - 1
  std::vector<std::vector<int>> cliques;  ///< points that are coupled with each other
  int constant = 0;  ///< cliques before this one couple them by numbers that never change
  std::vector<std::vector<int>> borders;  ///< of each multiplier: its points
  /// Of each multiplier that need not wait for all of its points, the one that it comes right
  /// after: of a substitution the point of a coordinate that it can be solved for and that no other
  /// substitution has, of another row one that no other row has. -1 for others; none where the list
  /// is empty.
  std::vector<int> solved = {};

  [[nodiscard]] bool is_substitution(int m) const { return !solved.empty() && solved[m] >= 0; }
};

/// Columns that are eliminated together: `pivots` of them, with rows below in `border` others. They
/// lie in the storage column by column from `base` on, `stride` apart: pivots first, then border.
struct Front {
  int first = 0;   ///< row of the first pivot
  int pivots = 0;  ///< columns
  int border = 0;
  int stride = 0;
  int base = 0;
  int rows = 0;          ///< where Program::border_rows has its border
  int groups_begin = 0;  ///< its updates, in Program::groups
  int groups_end = 0;
};

/// Where border columns begin … end - 1 of a front's update go: into columns of one later front.
struct Group {
  int begin = 0, end = 0;  ///< among the border
  int base = 0;            ///< storage of column `begin`, row 0 of that front
  int stride = 0;
  int positions = 0;  ///< where Program::positions has the place of each border row from `begin` on
  bool contiguous = false;  ///< these places follow each other
};

/// Numbers of the storage that follow each other.
struct Range {
  int begin = 0, end = 0;
};

/// Three planar points in a row, 0 - 1 - 2, eliminated from both ends, one number at a time: point
/// 0 has rows 0-1, point 2 rows 2-3, point 1 rows 4-5, so row_of_node = {0, 4, 2} and front_of_row
/// = {0, 0, 1, 1, 2, 2}. Each front has two pivots, each end a border of two:
///
///     front  first  border  rows it lists  base  stride  its column j begins at
///     0      0      2       4, 5           0     4       4 j
///     1      2      2       4, 5           8     4       8 + 4 j
///     2      4      0                      16    2       16 + 2 j
///
/// Storage: 20 numbers. Both ends have one group {begin 0, end 2, base 16, stride 2} with positions
/// {0, 1}: border column k of an update goes to column k of front 2. entry(5, 0) is 3, the last row
/// of column 0; entry(5, 4) is 17. Eight numbers at a time, all three are predicted faster as one
/// front.
struct Program {
  int size = 0;         ///< rows; those of a point follow each other
  int padded = 0;       ///< rows, a multiple of the width
  int storage = 0;      ///< numbers in all fronts
  int width = 1;        ///< how many numbers a processor handles at once
  double cycles = 0.0;  ///< predicted time of a factorization
  std::vector<int> row_of_node;
  std::vector<int> front_of_row;
  std::vector<Front> fronts;    ///< in order of elimination
  int constant_fronts = 0;      ///< the first ones, which no multiplier borders on: compile()
  bool inverts_points = false;  ///< solves with these take the inverse
  std::vector<Group> groups;
  std::vector<int> border_rows;
  std::vector<int> positions;
  /// What a factorization may find changed, in whole vectors of eight numbers; width 1: none is
  /// listed. Wide fronts keep the matrix, all others write into it.
  std::vector<Range> changing;

  /// Where the entry (row, column) lies, row >= column, both coupled.
  [[nodiscard]] int entry(int row, int column) const;
};

/// What changes of a matrix [A Bᵀ; B −ε]: rows of B are Σ n_i e_i with n_i that change and e_i that
/// do not. Planar rods have n = u: numbers = 2. With masses at points alone axes are alike, and an
/// entry is K (n_k · n_l), three products; else K is a 2 × 2 matrix, and it takes six.
struct Changing {
  int numbers = 0;          ///< n_i of a row, at most; 0: A changes too
  bool axes_alike = false;  ///< A is one matrix for each axis of space, and so is B for given n_i

  /// Products that make one entry of B A⁻¹ Bᵀ.
  [[nodiscard]] int products(int dimension) const {
    const int vectors = numbers / dimension;
    return axes_alike ? vectors * vectors * (dimension + 1) : numbers * (numbers + 1);
  }
};

/// `width`: how many numbers a processor handles at once. If A never changes, the program may be
/// that of A, whose fronts are constant, and −ε − B A⁻¹ Bᵀ, if this is predicted faster.
Program compile(const Pattern& pattern, int width, const Changing& changing = {});

/// What chooses the kernel of a front: the pivots of its last panel, the lanes of vectors for rows
/// below, 0: none, and whether there are panels before that one. Of four pivots with a border of
/// three {4, 4}, without one {4, 0}; of 19 pivots, 8 + 8 + 3, {3, 8, true}.
struct FrontShape {
  int pivots = 0, lanes = 0;
  bool wide = false;
  bool operator==(const FrontShape&) const = default;
};
FrontShape front_shape(const Front& front);

}  // namespace mbs::compiled_ldl
