// Plain column-oriented loops: contiguous in memory, not blocked, blind to zeros and symmetry.
#include "matrix.hpp"

#include <algorithm>

namespace mbs::starting_dense {

namespace {

/// result (rows) += a (rows x cols, column by column) times x (cols). As in Fortran, the compiler
/// may rely on it that the three do not overlap.
void accumulate(int rows, int cols, const double* __restrict a, const double* __restrict x,
                double* __restrict result) {
  for (int k = 0; k < cols; ++k) {
    const double factor = x[k];
    const double* column = a + static_cast<std::size_t>(k) * rows;
    for (int i = 0; i < rows; ++i) result[i] += column[i] * factor;
  }
}

/// The same for result = a times x.
void multiply(int rows, int cols, const double* __restrict a, const double* __restrict x,
              double* __restrict result) {
  std::fill_n(result, rows, 0.0);
  accumulate(rows, cols, a, x, result);
}

}  // namespace

void transpose(const Matrix& matrix, Matrix& result) {
  for (int j = 0; j < result.cols(); ++j) {
    double* column = result.column(j);
    for (int i = 0; i < result.rows(); ++i) column[i] = matrix(j, i);
  }
}

void matmul(const Matrix& matrix, std::span<const double> x, Vector& result) {
  multiply(matrix.rows(), static_cast<int>(x.size()), matrix.data(), x.data(), result.data());
}

void add_product(const Matrix& matrix, int first, const Vector& x, Vector& result) {
  accumulate(matrix.rows(), static_cast<int>(x.size()), matrix.column(first), x.data(),
             result.data());
}

void matmul(const Matrix& left, const Matrix& right, Matrix& result) {
  for (int j = 0; j < result.cols(); ++j) {
    multiply(left.rows(), left.cols(), left.data(), right.column(j), result.column(j));
  }
}

}  // namespace mbs::starting_dense
