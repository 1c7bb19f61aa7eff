// The step of paper/README.md over sparse storage, for any solver of the tangent matrix.
#include "simulation.hpp"

#include <algorithm>
#include <vector>

#include "drivers.hpp"
#include "forces.hpp"
#include "jacobian.hpp"
#include "newmark.hpp"
#include "storage.hpp"
#include "tangent.hpp"

namespace mbs::csc_klu {
namespace {

template <int dim, TangentSolver Solver>
class NewtonSimulation final : public Simulation {
 public:
  NewtonSimulation(const Model& model, const StepSettings& settings)
      : Simulation(model, settings),
        settings_(settings),
        weight_(settings.step * settings.step / 4.0),
        n_(model.variables()),
        m_(model.constraints()),
        mass_(model),
        jacobian_pattern_(model),
        jacobian_(jacobian_pattern_),
        force_pattern_(model),
        forces_(force_pattern_, settings.step),
        has_forces_(forces_.any()),
        driver_pattern_(model, jacobian_pattern_),
        drivers_(driver_pattern_, jacobian_pattern_),
        has_drivers_(drivers_.any()),
        tangent_pattern_(model, jacobian_pattern_, force_pattern_),
        tangent_(tangent_pattern_, mass_values(model, tangent_pattern_.pattern),
                 weight_ * settings.penalty),
        weighted_force_(model.force().begin(), model.force().end()),
        q_(model.initial_position().begin(), model.initial_position().end()),
        v_(model.initial_velocity().begin(), model.initial_velocity().end()),
        a_(n_, 0.0),
        lambda_(m_, 0.0),
        phi_(m_, 0.0),
        reaction_(m_, 0.0),
        right_a_(n_, 0.0),
        solver_(tangent_.pattern(), initial_tangent(model)) {
    for (double& force : weighted_force_) force *= weight_;
  }

 private:
  void do_set_state(const State& state) override {
    std::ranges::copy(state.q, q_.begin());
    std::ranges::copy(state.v, v_.begin());
    std::ranges::copy(state.a, a_.begin());
    for (int i = 0; i < m_; ++i) lambda_[i] = state.lambda[jacobian_pattern_.model_row[i]];
  }

  void do_get_state(State& state) const override {
    std::copy_n(q_.begin(), n_, state.q.begin());
    std::copy_n(v_.begin(), n_, state.v.begin());
    std::ranges::copy(a_, state.a.begin());
    for (int i = 0; i < m_; ++i) state.lambda[jacobian_pattern_.model_row[i]] = lambda_[i];
  }

  StepOutcome do_step() override {
    if (has_drivers_) drivers_.sample(time(), q_.data(), v_.data(), right_v_.data());
    predict(n_, settings_.step, q_.data(), v_.data(), a_.data());
    phases_.enter(Phase::evaluation);
    evaluate_constraints();
    StepOutcome outcome{StepStatus::pass_limit, 0};
    do {
      ++outcome.passes;
      phases_.enter(Phase::evaluation);
      evaluate_residual();
      phases_.enter(Phase::assembly);
      assemble_tangent();
      phases_.enter(Phase::factorization);
      if (!solver_.factorize(tangent_.values())) {
        phases_.enter(Phase::other);
        return {StepStatus::factorization_failed, outcome.passes};
      }
      phases_.enter(Phase::solve);
      solver_.solve(right_a_);
      phases_.enter(Phase::other);
      if (correct(n_, settings_.step, settings_.tolerance, right_a_.data(), q_.data(), v_.data(),
                  a_.data())) {
        outcome.status = StepStatus::converged;
      }
      phases_.enter(Phase::evaluation);
      evaluate_constraints();
      phases_.enter(Phase::other);
      update_multipliers();
    } while (outcome.status != StepStatus::converged && outcome.passes < settings_.max_passes);
    if (settings_.projections != Projections::none) project();
    phases_.enter(Phase::other);
    return outcome;
  }

  /// Completes the extended vectors and evaluates T at the start.
  std::span<const double> initial_tangent(const Model& model) {
    const std::vector<double> fixed = fixed_coordinates(model);
    q_.insert(q_.end(), fixed.begin(), fixed.end());
    v_.resize(q_.size(), 0.0);
    right_v_.resize(q_.size(), 0.0);
    if (has_drivers_) drivers_.sample(0.0, q_.data(), v_.data(), right_v_.data());
    evaluate_constraints();
    if (has_forces_) forces_.evaluate(q_.data(), v_.data(), right_a_.data());
    assemble_tangent();
    return tangent_.values();
  }

  void evaluate_constraints() {
    jacobian_.evaluate(q_.data(), phi_.data());
    if (has_drivers_) drivers_.subtract_values(phi_.data());
  }

  void assemble_tangent() {
    tangent_.assemble(jacobian_);
    if (has_forces_) tangent_.add(forces_);
  }

  /// The right-hand side -f of Eq. (4), in right_a_.
  void evaluate_residual() {
    const double alpha = settings_.penalty;
    const double* __restrict const phi = phi_.data();
    const double* __restrict const lambda = lambda_.data();
    double* __restrict const reaction = reaction_.data();
    for (int i = 0; i < m_; ++i) reaction[i] = weight_ * (lambda[i] + alpha * phi[i]);  // Eq. (3)

    mass_.multiply(a_.data(), right_a_.data());
    const double* __restrict const force = weighted_force_.data();
    double* __restrict const right = right_a_.data();
    for (int i = 0; i < n_; ++i) right[i] = force[i] - weight_ * right[i];  // Eq. (3)
    jacobian_.subtract_transposed_product(reaction, right);                 // Eq. (3)
    if (has_forces_) forces_.evaluate(q_.data(), v_.data(), right);
    if (has_drivers_) drivers_.subtract_inertia(weight_, right);
  }

  void update_multipliers() {
    const double alpha = settings_.penalty;
    const double* __restrict const phi = phi_.data();
    double* __restrict const lambda = lambda_.data();
    for (int i = 0; i < m_; ++i) lambda[i] += alpha * phi[i];  // Eq. (1)
  }

  /// Eq. (6) with the last factors; the solutions are solved for in the buffers that become v, a.
  void project() {
    const bool both = settings_.projections == Projections::both;
    const double factor = weight_ * settings_.penalty;
    phases_.enter(Phase::projection);
    if (both) {
      mass_.multiply(v_.data(), a_.data(), right_v_.data(), right_a_.data());
    } else {
      mass_.multiply(v_.data(), right_v_.data());
    }
    if (has_forces_) forces_.add_product(v_.data(), right_v_.data());
    if (has_forces_ && both) forces_.add_product(a_.data(), right_a_.data());
    if (has_drivers_) drivers_.subtract_rates(jacobian_, q_.data(), factor, right_v_.data());
    phases_.enter(Phase::solve);
    solver_.solve({right_v_.data(), static_cast<std::size_t>(n_)});
    v_.swap(right_v_);
    if (!both) return;
    phases_.enter(Phase::projection);
    jacobian_.velocity_term(v_.data(), factor, reaction_.data());
    jacobian_.subtract_transposed_quadratics(reaction_.data(), right_a_.data());
    if (has_drivers_) {
      drivers_.subtract_accelerations(jacobian_, q_.data(), factor, right_a_.data());
    }
    phases_.enter(Phase::solve);
    solver_.solve(right_a_);
    a_.swap(right_a_);
  }

  const StepSettings settings_;
  const double weight_;  ///< dt^2/4, s^2
  const int n_, m_;

  const MassMatrix mass_;
  const JacobianPattern<dim> jacobian_pattern_;
  Jacobian<dim> jacobian_;
  const ForcePattern force_pattern_;
  Forces<dim> forces_;
  const bool has_forces_;
  const DriverPattern<dim> driver_pattern_;
  Drivers<dim> drivers_;
  const bool has_drivers_;
  const TangentPattern<dim> tangent_pattern_;
  Tangent<dim> tangent_;

  std::vector<double> weighted_force_;  ///< dt^2/4 times the constant part of Q (n)
  std::vector<double> q_, v_;           ///< extended by the fixed points and their velocity
  std::vector<double> a_;               ///< n
  std::vector<double> lambda_, phi_;    ///< m, in the order of JacobianPattern
  std::vector<double> reaction_;        ///< m; what Phi_q^T multiplies
  std::vector<double> right_v_;         ///< extended; right-hand side and solution for v'
  std::vector<double> right_a_;         ///< n; the same for Delta q and a'
  Solver solver_;
};

}  // namespace

template <TangentSolver Solver>
std::unique_ptr<Simulation> create_simulation(const Model& model, const StepSettings& settings) {
  if (model.dimension() == 2) return std::make_unique<NewtonSimulation<2, Solver>>(model, settings);
  return std::make_unique<NewtonSimulation<3, Solver>>(model, settings);
}

template std::unique_ptr<Simulation> create_simulation<Refactorization>(const Model&,
                                                                        const StepSettings&);
template std::unique_ptr<Simulation> create_simulation<Factorization>(const Model&,
                                                                      const StepSettings&);
template std::unique_ptr<Simulation> create_simulation<GuardedRefactorization>(const Model&,
                                                                               const StepSettings&);

}  // namespace mbs::csc_klu
