// The slow, readable reference in long double that every implementation is held against.
#pragma once

#include <array>
#include <vector>

#include "mbs/simulation.hpp"
#include "model_math/known_motion.hpp"
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

  using Triple = std::array<Real, 3>;

  /// A spring or torsion spring at q, v: Eq. (11).
  struct Element {
    std::array<int, 4> points{};       // -1: unused
    std::array<Triple, 4> gradient{};  // g at each of them
    Real force = 0;                    // k (s - s_0) + c s'
    Real weight = 0;                   // of g g^T in T: dt/2 c + dt^2/4 k
    Real transverse = 0;               // of I - e e^T in T: dt^2/4 p
  };

  [[nodiscard]] Triple position(int point) const;
  [[nodiscard]] Triple velocity(int point) const;
  [[nodiscard]] Triple difference(int a, int b) const;                     // r_a - r_b
  [[nodiscard]] Triple velocity_difference(int a, int b) const;            // with driven points
  [[nodiscard]] Triple known_velocity_difference(int a, int b) const;      // of driven points alone
  [[nodiscard]] Triple known_acceleration_difference(int a, int b) const;  // likewise
  [[nodiscard]] Triple axis(int point) const;
  /// Where the coordinate of a point is in q; -1 for fixed and driven points.
  [[nodiscard]] int offset(int point) const { return model_.points()[point].offset; }

  [[nodiscard]] Vector constraints() const;         // Phi(q, t)
  [[nodiscard]] std::vector<Row> jacobian() const;  // Phi_q(q, t)
  [[nodiscard]] Vector partial_rate() const;        // Phi_t
  [[nodiscard]] Vector curvature() const;           // (Phi_q)' v + (Phi_t)'
  [[nodiscard]] Vector applied_force() const;       // Q(q, v, t)
  [[nodiscard]] Element spring_element(const Spring& spring) const;
  [[nodiscard]] Element torsion_element(const TorsionSpring& spring) const;
  [[nodiscard]] std::vector<Element> elements() const;
  [[nodiscard]] Vector mass_times(const Vector& x) const;
  /// [M + dt/2 C + dt^2/4 K] x with the C and K of the last pass.
  [[nodiscard]] Vector weighted_mass_times(const Vector& x) const;
  [[nodiscard]] Vector transpose_times(const std::vector<Row>& rows, const Vector& x) const;
  [[nodiscard]] std::vector<int> envelope() const;
  void add_element(const Element& element);  // to the tangent
  void assemble_tangent(const std::vector<Row>& rows);
  void project();

  const Model& model_;
  StepSettings settings_;
  int n_, m_;
  Vector q_, v_, a_, lambda_;
  KnownMotion known_;
  std::vector<Element> last_elements_;  // those in the tangent
  EnvelopeCholesky tangent_;
};

}  // namespace mbs
