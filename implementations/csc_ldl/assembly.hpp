// The matrix of a pass, T of Eq. (5) or the saddle-point matrix of Eq. (12), in the order of
// elimination.
#pragma once

#include <vector>

#include "constraints.hpp"
#include "elements.hpp"
#include "mbs/simulation.hpp"
#include "ordering.hpp"
#include "solver.hpp"
#include "sums.hpp"

namespace mbs::csc_ldl {

/// Where unknowns are. The state has the model's coordinates in the order of elimination, so that
/// in the penalty form the system is in the state's order and nothing is permuted in a step.
struct Numbering {
  std::vector<int> state;     ///< of a coordinate of the model: its place in the state
  std::vector<int> variable;  ///< of one of the state: its place in the system
  std::vector<int> row;       ///< saddle-point form, of a row of Constraints: the same
};
Numbering number_unknowns(const Model& model, bool saddle_point, Order order);

/// Entries are constants and sums of parts: of products of Phi_q's entries or, in saddle-point
/// form, of these themselves, and of what springs and laws give.
class Assembly {
 public:
  Assembly(const Model& model, const StepSettings& settings, const Numbering& numbering,
           const Constraints& constraints, const Elements& elements);

  /// For Elements::evaluate().
  [[nodiscard]] double* element_parts() { return parts_.data() + row_parts_; }
  /// With Phi_q as it is now, and with element_parts().
  void assemble(const Constraints& constraints);

  [[nodiscard]] bool factorize() { return solver_.factorize(); }
  /// Eq. (4) or (12): right-hand sides when they arrive, by variable and, in saddle-point form
  /// alone, by row; then solutions.
  void solve(std::vector<double>& top, std::vector<double>& bottom);

  /// T or the first n rows and columns of the saddle-point matrix, both halves; entry (i, j) of the
  /// model's coordinates at i n + j.
  [[nodiscard]] std::vector<double> dense() const;

 private:
  const bool saddle_point_;
  const double factor_;  // (dt^2/4) alpha
  const Numbering numbering_;
  UpperPattern pattern_;
  std::vector<double> constant_;  // of every entry
  Sums sums_;
  int row_parts_;
  std::vector<double> parts_, ones_;
  LdlSolver solver_;
  std::vector<double> system_;  // saddle-point form: right-hand side, then solution
};

}  // namespace mbs::csc_ldl
