// Constraints u . B w = s lowered to flat arrays: all dot constraints but distances, and bilinear.
#pragma once

#include <array>
#include <vector>

#include "coordinates.hpp"
#include "entries.hpp"

namespace mbs::csc_cholmod {

using Matrix = std::array<std::array<double, 3>, 3>;

/// One constraint u . B w = s with u = r_a - r_b, w = r_c - r_d, points of the model.
struct PairConstraint {
  int a = 0, b = 0, c = 0, d = 0;
  const Matrix* B = nullptr;  ///< nullptr: the identity
};

/// Many of one kind. u and w stand in runs: element axis * count + k of constraint k. A Jacobian
/// value is of_u * B^T u + of_w * B w with factors -1, 0, 1, because points may coincide.
struct PairBlock {
  /// Numbers of the block's first row, value and product among those of all blocks.
  struct First {
    int row = 0, value = 0, product = 0;
  };

  /// Appends one row a constraint to `rows`. Either all constraints have a B or none.
  PairBlock(const std::vector<PairConstraint>& constraints, const Coordinates& coordinates,
            const First& start, SignedRows& rows);

  /// Index of the product of values i and j of `row`, numbered among all blocks.
  [[nodiscard]] int product(int row, int i, int j) const;
  [[nodiscard]] int values() const { return static_cast<int>(source.size()); }
  [[nodiscard]] int products() const { return static_cast<int>(left.size()); }

  int count = 0;
  int dimension = 0;
  First first;
  std::vector<int> a, b, c, d;     ///< dimension x count, places
  std::vector<double> matrix;      ///< B in runs as well, row by row; empty: the identity
  std::vector<int> source, row;    ///< values: element of u and w; row
  std::vector<double> of_u, of_w;  ///< values
  std::vector<int> value_start;    ///< count + 1
  std::vector<int> left, right;    ///< products: the two values (left <= right), of one row
  std::vector<int> product_start;  ///< count + 1

 private:
  void add_places(const PairConstraint& constraint, int k, const Coordinates& coordinates);
  void add_values(const PairConstraint& constraint, int k, const Coordinates& coordinates,
                  SignedRows& rows);
  void add_products();
};

}  // namespace mbs::csc_cholmod
