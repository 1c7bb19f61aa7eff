// The constant mass matrix and its product with a vector.
#pragma once

#include <vector>

#include "mbs/model.hpp"
#include "pattern.hpp"

namespace mbs::csc_cholmod {

/// M (n x n, kg): the diagonal, then the other entries. Where rows of a column of one half lie
/// close together they become a segment, a run of consecutive rows with zeros in its gaps, which
/// vector instructions multiply; artificial fill makes long ones. What is left stands by rows, of
/// both halves: rows of few entries sum up on their own, whereas a column would add to several
/// places.
class MassMatrix {
 public:
  /// Unknown i of the model is row `number[i]` here. Stored zeros stay stored.
  MassMatrix(const Model& model, Half half, const std::vector<int>& number);

  /// result = b - M x; n each, no two overlap.
  void subtract_product(const double* b, const double* x, double* result) const;

 private:
  struct Entry {
    int row = 0;
    int column = 0;
    double value = 0.0;
  };
  /// Rows of equally many entries.
  struct Group {
    int entries = 0;  ///< of each row
    int rows = 0;
  };
  struct Segment {
    int column = 0;
    int first_row = 0;
    int length = 0;
  };
  /// result -= M x but for diagonal and segments.
  void subtract_rows(const double* x, double* result) const;
  /// Makes segments, and `loose` of the rest.
  void add_column(int column, const int* row, const double* value, int count,
                  std::vector<Entry>& loose);
  void add_rows(std::vector<Entry>& loose);

  std::vector<double> diagonal_;
  std::vector<Group> groups_;
  std::vector<int> row_;     ///< group after group
  std::vector<int> column_;  ///< the entries of each row, in the same order
  std::vector<double> value_;
  std::vector<Segment> segments_;
  std::vector<double> segment_value_;  ///< one after another
};

}  // namespace mbs::csc_cholmod
