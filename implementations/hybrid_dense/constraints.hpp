// Phi, its Jacobian as a sparse array, and the products with it: Eqs. (7) and (8).
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "slots.hpp"

namespace mbs::hybrid_dense {

/// D is the dimension. Rows are in an order of their own: distances, dots, bilinear, linear. A row
/// of Phi_q has an entry for every component of its points, fixed ones too: 2 D of a distance (two
/// points), 4 D of a dot or bilinear constraint, one a term of a linear one.
template <int D>
class Constraints {
 public:
  Constraints(const Model& model, const Slots& slots);

  /// Driven values, at time t.
  void drive(double t);

  /// Phi and Phi_q at q.
  void evaluate(const double* q, double* Phi, double* Phi_q) const;
  /// f += Phi_q^T y.
  void add_forces(const double* Phi_q, const double* y, double* f) const;
  /// y = Phi_q x.
  void multiply(const double* Phi_q, const double* x, double* y) const;
  /// Of Phi by time, with v and a of all points, driven ones too: Phi_q v + Phi_t, and
  /// Phi_q a + Phi_dot_q v + Phi_dot_t.
  void first_derivative(const double* Phi_q, const double* v, double* result) const;
  void second_derivative(const double* Phi_q, const double* v, const double* acceleration,
                         double* result) const;

  [[nodiscard]] int count() const { return static_cast<int>(order_.size()); }
  /// Entries of row k are firsts()[k] ... firsts()[k + 1] - 1; entry e is of the coordinate
  /// slots()[e].
  [[nodiscard]] std::span<const int> firsts() const { return first_; }
  [[nodiscard]] std::span<const int> slots() const { return slot_; }
  [[nodiscard]] int entries() const { return first_.back(); }
  /// The model's index of row k.
  [[nodiscard]] int model_row(int k) const { return order_[k]; }
  /// Writes the entries that never change.
  void write_constants(double* Phi_q) const;

 private:
  struct Distance {
    int a, b;
    double value;
  };
  struct Dot {
    int a, b, c, d;
    double value;
  };
  struct Bilinear {
    Dot dot;
    std::array<std::array<double, D>, D> B;
  };
  struct Linear {
    int first, end;
    double value;
  };
  struct Function {
    int row;
    TimeFunction value;
    double* target;
    TimeFunction::Sample now;
  };

  std::vector<Distance> distances_;
  std::vector<Dot> dots_;
  std::vector<Bilinear> bilinear_;
  std::vector<Linear> linear_;
  std::vector<double> coefficients_;  // of linear rows, one behind the other
  std::vector<int> first_, slot_, order_;
  std::vector<Function> functions_;
};

}  // namespace mbs::hybrid_dense
