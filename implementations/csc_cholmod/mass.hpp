// The constant mass matrix and its products with vectors.
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
  /// result = M x; n each, they do not overlap.
  void product(const double* x, double* result) const;
  /// first = M x, second = M y in one sweep; n each, no two overlap.
  void products(const double* x, const double* y, double* first, double* second) const;

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
  /// result += kSign * M x but for the diagonal.
  template <int kSign>
  void add_off_diagonal(const double* x, double* result) const;
  /// Calls visit(row, number of entries, columns, values) for each row; the number is a constant
  /// where it is small.
  template <typename Visit>
  void for_rows(Visit visit) const;
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
