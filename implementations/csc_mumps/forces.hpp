// Springs, torsion springs and couples: Q, and their share of T, Eq. (11).
#pragma once

#include <initializer_list>
#include <vector>

#include "mbs/model.hpp"
#include "points.hpp"

namespace mbs::csc_mumps {

/// Every element is a row g of gradients by its free coordinates: springs first, then torsion
/// springs, then couples (whose scalar force is minus the torque). The first two couple their
/// coordinates in T: by g g' times a number, and by a transverse part for springs.
class Forces {
 public:
  Forces() = default;
  /// `step` = Delta t (s).
  Forces(const Model& model, const ExtendedPoints& points, double step);

  [[nodiscard]] bool empty() const { return start_.size() < 2; }

  /// visit(row, column), row >= column, of every entry that each element has in T.
  template <class Visit>
  void visit_couplings(Visit visit) const {
    for (int row = 0; row < coupling_rows(); ++row) {
      for (int i = start_[row]; i < start_[row + 1]; ++i) {
        for (int j = start_[row]; j <= i; ++j) visit(column_[i], column_[j]);
      }
    }
  }

  /// Gradients and factors at q, v (extended); right (n) -= Q of the elements.
  void evaluate(const double* q, const double* v, double* right);
  /// tangent += (Delta t / 2) C + (Delta t^2 / 4) K, with the gradients evaluated last; `place` has
  /// the place in it of each entry, in the order of visit_couplings().
  void add_to_tangent(const int* place, double* tangent) const;

 private:
  // Points by their offsets in an extended vector.
  struct SpringElement {
    int a, b;
    double stiffness, damping, length;
    double weight;  // of e e' in T
  };
  struct TorsionElement {
    int a, b, c, d, axis;
    double stiffness, damping, angle;
  };
  struct CoupleElement {
    int a, b, axis;
    double torque;
  };

  /// The elements that couple coordinates in T come first.
  [[nodiscard]] int coupling_rows() const { return static_cast<int>(rank_.size()); }
  void add_row(const ExtendedPoints& points, std::initializer_list<int> row);
  template <int kDimension>
  const int* evaluate_springs(const double* q, const double* v, const int* place, double* right);
  template <int kDimension>
  const int* evaluate_torsion(const double* q, const double* v, const int* place, double* right);
  template <int kDimension>
  void evaluate_couples(const double* q, const int* place, double* right);
  void apply(int row, double force, double* right) const;

  int dimension_ = 0;
  double quarter_ = 0.0;  // Delta t^2 / 4
  std::vector<SpringElement> springs_;
  std::vector<TorsionElement> torsion_springs_;
  std::vector<CoupleElement> couples_;

  // Row i of gradients is [start_[i], start_[i + 1]) of column_ and gradient_. write_order_ lists
  // the places in gradient_ in the order of evaluation; the one behind the last is for fixed
  // points.
  std::vector<int> start_, column_;
  std::vector<double> gradient_;
  std::vector<int> write_order_;

  std::vector<double> rank_;        // a coupling row: factor of g g'
  std::vector<double> transverse_;  // a spring: factor of the identity in its 2 x 2 blocks
};

}  // namespace mbs::csc_mumps
