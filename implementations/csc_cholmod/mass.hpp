// The constant mass matrix and its products with vectors.
#pragma once

#include <vector>

#include "mbs/model.hpp"
#include "pattern.hpp"

namespace mbs::csc_cholmod {

/// M (n x n, kg), one half: the diagonal, then the other entries by columns. Where rows of a column
/// lie close together they become a segment, a run of consecutive rows with zeros in its gaps,
/// which vector instructions multiply; artificial fill makes long ones.
class MassMatrix {
 public:
  /// Unknown i of the model is row `number[i]` here. Stored zeros stay stored.
  MassMatrix(const Model& model, Half half, const std::vector<int>& number);

  /// result = b - M x; n each, no two overlap.
  void subtract_product(const double* b, const double* x, double* result) const;
  /// result = M x; n each, they do not overlap.
  void product(const double* x, double* result) const;
  /// first = M x, second = M y in one sweep; n each, no two overlap.
  void products(const double* x, const double* y, double* first, double* second) const;

 private:
  struct Column {
    int column = 0;
    int entries = 0;
  };
  struct Segment {
    int column = 0;
    int first_row = 0;
    int length = 0;
  };
  /// result += kSign * M x but for the diagonal.
  template <int kSign>
  void add_off_diagonal(const double* x, double* result) const;
  void add_column(int column, const int* row, const double* value, int count);

  std::vector<double> diagonal_;
  std::vector<Column> columns_;  ///< those with entries outside segments
  std::vector<int> row_;
  std::vector<double> value_;
  std::vector<Segment> segments_;
  std::vector<double> segment_value_;  ///< one after another
};

}  // namespace mbs::csc_cholmod
