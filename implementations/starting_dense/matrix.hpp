// The dense matrix of Fortran 90 and its intrinsics TRANSPOSE and MATMUL as plain loops.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mbs::starting_dense {

/// rows x cols numbers, column by column, every one of them stored; zero at first.
///
/// Example: [1 3 5; 2 4 6] is rows = 2, cols = 3, data 1 2 3 4 5 6, and (1, 2) is 6.
class Matrix {
 public:
  Matrix(int rows, int cols)
      : rows_(rows), cols_(cols), data_(static_cast<std::size_t>(rows) * cols) {}

  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int cols() const { return cols_; }
  double& operator()(int row, int col) { return column(col)[row]; }
  [[nodiscard]] double operator()(int row, int col) const { return column(col)[row]; }

  double* data() { return data_.data(); }
  double* column(int col) { return data_.data() + static_cast<std::size_t>(col) * rows_; }
  [[nodiscard]] const double* data() const { return data_.data(); }
  [[nodiscard]] const double* column(int col) const {
    return data_.data() + static_cast<std::size_t>(col) * rows_;
  }
  [[nodiscard]] std::size_t size() const { return data_.size(); }

 private:
  int rows_;
  int cols_;
  std::vector<double> data_;
};

using Vector = std::vector<double>;

/// result (c x r) = transposed first c columns of `matrix` (r x c or wider). The two are distinct.
void transpose(const Matrix& matrix, Matrix& result);

/// result (r) = columns 0, 1, ... of `matrix` (r x c) times x, one column an entry of x, column
/// after column. `result` is not `x`.
void matmul(const Matrix& matrix, std::span<const double> x, Vector& result);

/// result (r) += columns first, first + 1, ... of `matrix` (r x c) times x, one column an entry of
/// x.
void add_product(const Matrix& matrix, int first, const Vector& x, Vector& result);

/// result (r x c) = left (r x k) times the first c columns of `right` (k x c or wider), one column
/// of the result after another, each as in the product above. All r k c products are formed.
/// `result` is neither factor.
void matmul(const Matrix& left, const Matrix& right, Matrix& result);

}  // namespace mbs::starting_dense
