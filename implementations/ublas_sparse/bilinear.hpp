// The bilinear constraints of a Model and their evaluation.
#pragma once

#include <array>
#include <vector>

#include "columns.hpp"
#include "mbs/model.hpp"
#include "points.hpp"

namespace mbs::ublas_sparse {

using Matrix3 = std::array<Triple, 3>;  // B[row][column]

[[nodiscard]] Triple times(const Matrix3& B, const Triple& w);
[[nodiscard]] Triple transposed_times(const Matrix3& B, const Triple& u);

/// The constraints u . B w - s of Eq. (7). Vectors have the size of all of Phi (m); each function
/// writes the rows of these constraints alone.
class BilinearConstraints {
 public:
  BilinearConstraints(const Model& model, const Points& points, int first_row);

  void append_positions(const Points& points, std::vector<Entry>& entries) const;
  /// `values`: s of every constraint (m).
  void evaluate(const Points& points, const std::vector<double>& values, Vector& Phi) const;
  void evaluate_jacobian(const Points& points, SparseMatrix& Phi_q) const;
  /// 2 u' . B w'.
  void evaluate_acceleration_term(const Points& points, Vector& term) const;

 private:
  struct Bilinear : Quadratic {
    Matrix3 B;
  };

  std::vector<Bilinear> bilinears_;
  std::vector<Column> columns_;
};

}  // namespace mbs::ublas_sparse
