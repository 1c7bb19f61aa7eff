// The slow, readable reference in long double that every implementation is held against.
#pragma once

#include <optional>
#include <vector>

#include "mbs/simulation.hpp"
#include "reference/envelope_cholesky.hpp"

namespace mbs {

/// "The step" of paper/README.md, literally, in 80-bit arithmetic. Used for nothing but checking.
/// Stored zeros of M are skipped: they do not change the physics.
class ReferenceSimulation final : public Simulation {
 public:
  using Real = long double;
  using Vector = std::vector<Real>;

  /// `model` must outlive the simulation.
  ReferenceSimulation(const Model& model, const StepSettings& settings);

  /// Condition number (2-norm) of the tangent of the last step, to a few per cent.
  [[nodiscard]] double tangent_condition();

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

 private:
  struct Entry {
    int coordinate;
    Real value;
  };
  using Row = std::vector<Entry>;  // of the Jacobian; a coordinate may occur more than once

  [[nodiscard]] Real coordinate(const Vector& x, int point, int axis) const;
  [[nodiscard]] Real velocity(const Vector& x, int point, int axis) const;
  [[nodiscard]] Vector constraints() const;         // Phi(q)
  [[nodiscard]] std::vector<Row> jacobian() const;  // Phi_q(q)
  [[nodiscard]] Vector curvature() const;           // (Phi_q)' v
  [[nodiscard]] Vector mass_times(const Vector& x) const;
  [[nodiscard]] Vector transpose_times(const std::vector<Row>& rows, const Vector& x) const;
  [[nodiscard]] std::vector<int> envelope() const;
  void assemble_tangent(const std::vector<Row>& rows);
  void project();

  const Model& model_;
  StepSettings settings_;
  int n_, m_;
  Vector q_, v_, a_, lambda_;
  EnvelopeCholesky tangent_;
};

}  // namespace mbs
