// The slow, readable reference in long double that every implementation is held against.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "mbs/simulation.hpp"
#include "model_math/known_motion.hpp"
#include "reference/envelope_ldlt.hpp"

namespace mbs {

/// "The step" of paper/README.md and paper/other_schemes.md, literally, in 80-bit
/// arithmetic; `precision` only refines the projections as it asks for. Used for nothing but
/// checking. Stored zeros of M are skipped: they do not change the physics.
///
/// All of its systems of equations are one, Eqs. (12) to (15),
///
///   [ T_0    Phi_q^T ] [x]   [ top    ]
///   [ Phi_q  -eps    ] [y] = [ bottom ]
///
/// which the penalty form solves as T x = top + Phi_q^T bottom / eps, the others as it stands.
class ReferenceSimulation final : public Simulation {
 public:
  using Real = long double;
  using Vector = std::vector<Real>;
  using Triple = std::array<Real, 3>;

  static Real dot(const Triple& x, const Triple& y) {
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  }

  /// `model` must outlive the simulation.
  ReferenceSimulation(const Model& model, const StepSettings& settings);

  /// What multiplies an error of Phi in lambda, to a few per cent: alpha in the penalty form. In
  /// the others 4/dt^2 |(eps + Phi_q T_0^-1 Phi_q^T)^-1| with the last factors, at most alpha, and
  /// far less where no constraint depends on others.
  [[nodiscard]] double effective_penalty() const;

  /// Condition number (2-norm) of the tangent (5) after the last step, with the effective penalty
  /// factor, to a few per cent.
  [[nodiscard]] double tangent_condition() const;

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;
  /// In the penalty form.
  bool do_show_first_pass(FirstPass& pass) override;

 private:
  struct Entry {
    int coordinate;
    Real value;
  };
  using Row = std::vector<Entry>;  // of the Jacobian; a coordinate may occur more than once

  /// A spring, torsion spring or law at q, v: Eqs. (11), (18).
  struct Element {
    std::array<int, 4> points{};       // -1: unused
    std::array<Triple, 4> gradient{};  // g at each of them
    Real force = 0;                    // k (s - s_0) + c s', F
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
  /// The force of an element at its s and s', and the derivatives by both.
  struct Response {
    Real force = 0, stiffness = 0, damping = 0;
    Real held = 0;  // the part of the force that does not depend on s'
  };
  [[nodiscard]] Response respond(const Law& law, Real s, Real rate) const;
  template <class Line, class Respond>
  [[nodiscard]] Element line_element(const Line& line, Respond&& respond) const;
  template <class Corner, class Respond>
  [[nodiscard]] Element corner_element(const Corner& corner, Respond&& respond) const;
  /// Eq. (3) without alpha Phi, which solve() adds: f_0 of Eq. (12).
  [[nodiscard]] Vector residual(const std::vector<Row>& rows) const;
  [[nodiscard]] std::vector<Element> elements() const;
  struct MatrixEntry {
    int row, col;
    Real value;
  };
  /// dt^2/4 times the sum of Eq. (16), all of its entries; none unless the setting asks for it.
  [[nodiscard]] std::vector<MatrixEntry> geometric_stiffness() const;
  [[nodiscard]] Vector mass_times(const Vector& x) const;
  /// T_0 x with the C and K of the last pass.
  [[nodiscard]] Vector weighted_mass_times(const Vector& x) const;
  [[nodiscard]] Vector times(const std::vector<Row>& rows, const Vector& x) const;
  [[nodiscard]] Vector transpose_times(const std::vector<Row>& rows, const Vector& x) const;

  struct Solution {
    Vector x, y;  // n; m, empty in the penalty form
  };
  [[nodiscard]] bool is_saddle() const { return settings_.scheme != Scheme::penalty; }
  /// Or the multistep method, which starts with it.
  [[nodiscard]] bool is_rattle() const {
    return is_saddle() && settings_.scheme != Scheme::saddle_point;
  }
  void set_up_matrix();
  /// place_ for the coordinates in this order. Each multiplier follows as soon as all coordinates
  /// of one of its `groups` are there.
  [[nodiscard]] std::vector<int> places(
      const std::vector<int>& coordinates,
      const std::vector<std::vector<std::vector<int>>>& groups) const;
  void solve_matrix(Vector& x) const;  // of the unknowns, not of their places
  /// T, or the matrix of (12) or (14), at the present state.
  [[nodiscard]] bool factorize(const std::vector<Row>& rows);
  void assemble(const std::vector<Row>& rows);
  void add_element(const Element& element);  // to the matrix
  [[nodiscard]] Solution solve(const std::vector<Row>& rows, const Vector& top,
                               const Vector& bottom) const;

  StepOutcome trapezoidal_step();
  void predict();
  struct Pass {
    Vector q;               // before its correction
    std::vector<Row> rows;  // Phi_q there
  };
  /// Projections of the step; adds to `factorizations`. False if a factorization failed.
  [[nodiscard]] bool project(const Pass& last, int& factorizations);
  [[nodiscard]] bool refines_once() const;
  /// Eq. (15): x from x* on, until a correction is at most `small`.
  [[nodiscard]] bool refine(const std::vector<Row>& rows, Vector& x, const Vector& rate, Real small,
                            int& factorizations);

  StepOutcome rattle_step(Scheme scheme);
  struct StageOutcome {
    StepStatus status = StepStatus::converged;
    int passes = 0;
  };
  StageOutcome rattle_stage(Real h);
  /// Step 5 of a stage: a and lambda at (q, v).
  void rattle_acceleration(const std::vector<Row>& rows);
  /// v onto the constraints, as step 4 refines it.
  void rattle_velocity(const std::vector<Row>& rows);

  /// Eq. (17); the first steps are those of rattle6.
  StepOutcome multistep();
  /// v, a and lambda of the present q, which Eq. (17) does without.
  void complete_multistep();

  const Model& model_;
  StepSettings settings_;
  int n_, m_;
  Vector q_, v_, a_, lambda_;
  KnownMotion known_;
  long steps_ = 0;                      // since the last set_state()
  std::vector<Element> last_elements_;  // those in the matrix
  std::vector<MatrixEntry> last_geometric_;
  std::vector<int> place_;  // of q[i], then of y[k], in the matrix
  EnvelopeLdlt matrix_{{}};
  bool due_ = true;                // TangentReuse::kept: the factors are to be renewed
  std::deque<Vector> w_, past_a_;  // of Eq. (17), the last five, the newest first
};

}  // namespace mbs
