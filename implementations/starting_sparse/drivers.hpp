// What a scene prescribes as functions of time: driven points, driven values and driven mass.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::starting_sparse {

/// Samples the functions once a step and evaluates what they add to Phi_t and to its derivative.
/// Constraints that no driver touches do not occur here.
class Drivers {
 public:
  /// `point_offset`: of each point in an extended vector, see Assembly. `model` outlives this.
  Drivers(const Model& model, std::span<const int> point_offset);

  /// True if nothing depends on time; then drive() does nothing.
  [[nodiscard]] bool empty() const;
  /// Takes all functions at time t (s): positions into q and velocities into v (both extended),
  /// the values of constraints into `value` (m), driven mass into force().
  void drive(double t, double* q, double* v, double* value);
  /// Q (n, N) without springs and couples: the model's, with driven mass as last sampled.
  [[nodiscard]] std::span<const double> force() const;

  /// The rows of Phi that depend on time, ascending; the next two are in their order.
  [[nodiscard]] std::span<const int> rows() const { return rows_; }
  /// Phi_t at q (extended).
  std::span<const double> velocity_terms(const double* q) { return evaluate(rate_, q); }
  /// u_p'' . B w + u . B w_p'' - s'' at q (extended).
  std::span<const double> acceleration_terms(const double* q) { return evaluate(second_, q); }

 private:
  /// A quadratic constraint with driven points: offsets in extended vectors, then in
  /// Derivative::points; B is the identity for a dot constraint.
  struct Term {
    int row = 0;  // an index into rows_
    std::array<int, 4> point{}, driven{};
    std::array<std::array<double, 3>, 3> B{};
  };
  /// First or second derivatives: zero for undriven points, then each driven point; of the value
  /// of each of rows_.
  struct Derivative {
    std::vector<double> points, values;
  };

  void find_terms(std::span<const int> driven_offset);
  void number_rows();
  std::span<const double> evaluate(const Derivative& derivative, const double* q);

  const Model& model_;
  int dimension_ = 0;
  std::vector<int> point_offset_;  // of each driven point in an extended vector
  std::vector<int> mass_driven_;   // of each driven mass: its point in Derivative::points
  std::vector<int> value_row_;     // of each driven value: an index into rows_
  std::vector<int> rows_;
  std::vector<Term> terms_;
  Derivative rate_, second_;
  std::vector<double> result_;
  std::vector<double> force_;  // empty without driven mass
};

}  // namespace mbs::starting_sparse
