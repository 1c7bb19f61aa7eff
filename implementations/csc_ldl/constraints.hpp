// Phi and Phi_q, Eqs. (7) and (8), in groups of equal rows.
#pragma once

#include <functional>
#include <vector>

#include "group.hpp"
#include "mbs/model.hpp"

namespace mbs::csc_ldl {

/// Rows are sorted here: distances, other dots, bilinear, linear. All vectors over rows are in this
/// order.
class Constraints {
 public:
  Constraints(const Model& model, const Coordinates& at);

  [[nodiscard]] int count() const { return static_cast<int>(model_row_.size()); }
  /// The model's number of a row.
  [[nodiscard]] const std::vector<int>& model_row() const { return model_row_; }

  // For setup: what an entry sums up, among the parts that the two functions below write.
  using Visit = std::function<void(int, int, int)>;
  /// visit(row, i, part) for (row, i) of Phi_q.
  void visit_forces(const Visit& visit) const;
  /// visit(i, j, part) for (i, j) of Phi_q^T Phi_q, linear rows apart.
  void visit_products(const Visit& visit) const;
  /// visit(i, j, number): what linear rows add to it.
  void visit_linear(const std::function<void(int i, int j, double product)>& visit) const;
  [[nodiscard]] int force_parts() const { return force_parts_; }
  [[nodiscard]] int matrix_parts() const { return matrix_parts_; }

  /// Values that drivers prescribe, at time t.
  void drive(double t);
  void evaluate(const double* q);
  /// What the first and the second derivative of Phi by time have beside Phi_q v and Phi_q a, where
  /// v and a are those of all points.
  void rate(double* result) const;
  void second_rate(const double* v, double* result) const;
  /// y += Phi_q x, with what driven points have in x.
  void add_product(const double* x, double* y) const;
  /// factor Phi_q^T (Phi_q x + y), in parts.
  void write_reactions(double factor, const double* x, const double* y, double* parts) const;
  /// Phi_q^T g, in parts.
  void write_forces(const double* g, double* parts) const;
  /// factor Phi_q^T Phi_q of all rows but linear ones, in parts.
  void write_products(double factor, double* parts) const;

  std::vector<double> Phi;

 private:
  [[nodiscard]] double linear_product(int row, const double* x) const;
  template <int dimension>
  void evaluate_dots(const double* q);
  template <int dimension>
  void write_squares(const double* v, double* result) const;

  struct DrivenRow {
    int row;
    TimeFunction value;
  };
  int dimension_;
  Group distances_, dots_, bilinear_;
  struct Rows {
    const Group* group;
    int first;
  };
  std::vector<Rows> groups_;  // those that have members
  std::vector<double> B_;     // entry (r, c) of member k at (r * dimension + c) * count + k
  int first_linear_ = 0, first_linear_part_ = 0, force_parts_ = 0, matrix_parts_ = 0;
  std::vector<int> linear_begin_, linear_variable_;
  std::vector<double> linear_coefficient_;
  std::vector<int> model_row_;
  std::vector<double> value_, value_rate_, value_acceleration_;
  std::vector<DrivenRow> driven_;
};

}  // namespace mbs::csc_ldl
