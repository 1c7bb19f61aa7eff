// What is known of M, Phi_q and T before any value is: patterns, orders and schedules, built once.
//
// A numeric type of assembly.hpp is made from one of these and cannot be made without it. They hold
// all searching and all branching, so that the step has none.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_umfpack {

/// Where the entries of a square matrix are, by compressed columns. Of a symmetric matrix both
/// triangles are kept, so that columns are rows too.
///
/// Example: [x . x; . x .; x . x] has starts = {0, 2, 3, 5} and rows = {0, 2, 1, 0, 2}.
struct SparsityPattern {
  std::vector<int> starts;  ///< n + 1
  std::vector<int> rows;    ///< ascending within each column

  [[nodiscard]] int variables() const { return static_cast<int>(starts.size()) - 1; }
  /// Index of entry (row, col), which must be there; for set-up only.
  [[nodiscard]] int position(int row, int col) const;
};

/// The pattern of M.
SparsityPattern mass_pattern(const Model& model);

/// The constraints lowered to flat arrays, and the recorded order in which Phi_q is written.
///
/// Points are offsets into a vector x of n + (fixed coordinates) numbers: the free coordinates q,
/// then those of the fixed points. Rows are sorted by kind: distances to a fixed point (pins),
/// distances of two free points (links), other dot constraints, linear constraints. Phi_q of the
/// first three is stored as blocks of `dimension` numbers, one for each free point of a row.
///
/// Example: a pin A-B and a link B-C give the blocks {B, row 0}, {B, row 1}, {C, row 1}.
struct JacobianLayout {
  struct Distance {
    int a = 0, b = 0;    ///< offsets into x; a is free
    double value = 0.0;  ///< m^2
  };
  struct Dot {
    int a = 0, b = 0, c = 0, d = 0;  ///< offsets into x
    double value = 0.0;              ///< m^2
    int first = 0, last = 0;         ///< its blocks
  };
  struct Block {
    int offset = 0;  ///< first coordinate in q
    int row = 0;
  };
  /// A block of a Dot is of_cd (r_c - r_d) + of_ab (r_a - r_b), Eq. (7), with signs added up where
  /// points coincide: {1, 0} at a, {-1, 0} at b, {1, 1} at a point that is a and c.
  struct Signs {
    double of_cd = 0.0, of_ab = 0.0;
  };
  struct Linear {
    int first = 0, last = 0;  ///< its terms
    double value = 0.0;       ///< m
  };

  explicit JacobianLayout(const Model& model);

  int variables;
  std::vector<double> fixed;    ///< coordinates of the fixed points, the end of x (m)
  std::vector<int> order;       ///< order[row here] = row in the Model
  std::vector<Distance> pins;   ///< rows from 0; blocks from 0, one a row
  std::vector<Distance> links;  ///< the next rows and blocks, two blocks a row
  std::vector<Dot> dots;
  std::vector<Linear> linears;
  std::vector<Block> blocks;
  std::vector<Signs> dot_signs;  ///< of the blocks of dots, in their order
  std::vector<LinearConstraint::Term> terms;

 private:
  void add_points(const Model& model);
  void add_dot(const DotConstraint& dot);
  void add_linear(const LinearConstraint& linear);

  std::vector<int> offsets_;  ///< in x, of every point of the Model
};

/// The pattern of T, the union of those of M and Phi_q^T Phi_q, and the schedule of the rank-k
/// update: for every D x D block of T that dot constraints reach, which pairs of blocks of Phi_q
/// are multiplied and where the result goes.
template <int D>
struct TangentSchedule {
  struct Block {
    int first = 0, last = 0;        ///< its pairs
    std::array<int, D> position{};  ///< where each of its columns starts, in the values of T
    std::array<int, D> mirrored{};  ///< the same for the transposed block; equal on the diagonal
  };
  /// Blocks of Phi_q: the product is (block `row`) (block `col`)^T.
  struct Pair {
    int row = 0, col = 0;
  };

  TangentSchedule(const SparsityPattern& mass, const JacobianLayout& layout);

  SparsityPattern pattern;
  std::vector<Block> diagonal, lower;  ///< pairs of `diagonal` come first
  std::vector<Pair> pairs;
};

}  // namespace mbs::csc_umfpack
