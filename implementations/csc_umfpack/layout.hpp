// Points and constraints lowered to flat arrays: the order in which Phi_q is written, built once.
#pragma once

#include <span>
#include <vector>

#include "mbs/model.hpp"
#include "vectors.hpp"

namespace mbs::csc_umfpack {

/// Points as offsets into a vector x of n + (fixed coordinates) numbers: the free coordinates q,
/// then those of the fixed points, constant or driven, in the order of the Model.
struct PointLayout {
  /// A free point and the signs it has in two differences of points, r_a - r_b and r_c - r_d.
  struct Signs {
    int offset = 0;  ///< first coordinate in q
    double in_ab = 0.0, in_cd = 0.0;
  };

  explicit PointLayout(const Model& model);

  [[nodiscard]] bool is_free(int point) const { return offsets[point] < variables; }
  /// The free ones among the points a, b or a, b, c, d, each once with its signs added up:
  /// {1, 0} at a, {-1, 0} at b, {1, 1} at a point that is a and c.
  [[nodiscard]] std::vector<Signs> signs(std::span<const int> points) const;

  int variables;
  std::vector<int> offsets;   ///< in x, of every point of the Model
  std::vector<double> fixed;  ///< coordinates of the fixed points at t = 0, the end of x (m)
};

/// The constraints and the recorded order in which Phi_q is written.
///
/// Rows are sorted by kind: distances to a fixed point (pins), distances of two free points
/// (links), other dot constraints, bilinear constraints, linear constraints. Phi_q of all but the
/// last is stored as blocks of `dimension` numbers, one for each free point of a row.
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
  struct Bilinear : Dot {
    Matrix B{};
  };
  struct Block {
    int offset = 0;  ///< first coordinate in q
    int row = 0;
  };
  struct Linear {
    int first = 0, last = 0;  ///< its terms
    double value = 0.0;       ///< m
  };

  JacobianLayout(const Model& model, const PointLayout& points);

  [[nodiscard]] int rows() const { return static_cast<int>(order.size()); }
  /// The value of a row's constraint, which may be driven.
  [[nodiscard]] double& value(int row);

  std::vector<int> order;       ///< order[row here] = row in the Model
  std::vector<Distance> pins;   ///< rows from 0; blocks from 0, one a row
  std::vector<Distance> links;  ///< the next rows and blocks, two blocks a row
  std::vector<Dot> dots;
  std::vector<Bilinear> bilinears;
  std::vector<Linear> linears;
  std::vector<Block> blocks;
  std::vector<PointLayout::Signs> signs;  ///< of the blocks of dots and bilinears, in their order
  std::vector<LinearConstraint::Term> terms;

 private:
  /// Appends blocks of the next row; `points` are a, b, c, d.
  Dot add_product(const PointLayout& points, const std::array<int, 4>& abcd, double value);
  void add_linear(const LinearConstraint& linear);
};

}  // namespace mbs::csc_umfpack
