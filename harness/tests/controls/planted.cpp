// The paper's step over the harness's own mathematics, in Eigen's dense matrices.
#include "controls/planted.hpp"

#include <Eigen/Dense>

#include "model_math/kinematics.hpp"

namespace mbs::test {
namespace {

enum class Mistake {
  none,
  half_jacobian,
  half_mass,
  lambda_first,
  lambda_sign,
  no_curvature,
  always_both
};

template <Mistake kMistake, bool kShows>
class Planted final : public Simulation {
  using Vector = Eigen::VectorXd;

 public:
  Planted(const Model& model, const StepSettings& settings)
      : Simulation(model, settings),
        model_(model),
        settings_(settings),
        n_(model.variables()),
        m_(model.constraints()),
        scale_(settings.step * settings.step / 4) {
    M_ = Eigen::MatrixXd::Zero(n_, n_);
    for (const MassEntry& entry : model.mass()) {
      M_(entry.row, entry.col) = entry.value;
      if (kMistake != Mistake::half_mass) M_(entry.col, entry.row) = entry.value;
    }
    Q_ = Vector::Map(model.force().data(), n_);
  }

 private:
  void do_set_state(const State& state) override {
    q_ = Vector::Map(state.q.data(), n_);
    v_ = Vector::Map(state.v.data(), n_);
    a_ = Vector::Map(state.a.data(), n_);
    lambda_ = Vector::Map(state.lambda.data(), m_);
  }
  void do_get_state(State& state) const override {
    state.q = values(q_), state.v = values(v_), state.a = values(a_),
    state.lambda = values(lambda_);
  }

  StepOutcome do_step() override {
    StepOutcome outcome{StepStatus::pass_limit, 0};
    predict();
    while (outcome.status == StepStatus::pass_limit && outcome.passes < settings_.max_passes) {
      ++outcome.passes;
      evaluate();
      factors_.compute(T_);
      const Vector delta = factors_.solve(-f_);
      q_ += delta;
      v_ += 2 / settings_.step * delta;
      a_ += delta / scale_;
      if (delta.lpNorm<Eigen::Infinity>() <= settings_.tolerance) {
        outcome.status = StepStatus::converged;
      }
      const bool is_last =
          outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes;
      if (is_last) project();
      evaluate_constraints();
      const double sign = kMistake == Mistake::lambda_sign ? -1.0 : 1.0;
      if (kMistake != Mistake::lambda_first) lambda_ += sign * settings_.penalty * Phi_;
    }
    return outcome;
  }
  void project() {
    if (settings_.projections == Projections::none) return;
    const auto take_away = [&](Vector& x, const Vector& rate) {
      x -= scale_ * settings_.penalty * factors_.solve(Phi_q_.transpose() * (Phi_q_ * x + rate));
    };
    Vector rate = Vector::Zero(m_);
    take_away(v_, rate);
    if (settings_.projections == Projections::velocity && kMistake != Mistake::always_both) return;
    if (kMistake != Mistake::no_curvature) {
      constraint_curvature(model_, 0.0, values(q_), values(v_), {rate.data(), size(m_)});
    }
    take_away(a_, rate);
  }

  bool do_show_first_pass(FirstPass& pass) override {
    if (!kShows) return false;
    predict();
    evaluate();
    pass = {values(q_), values(v_), values(a_), values(Phi_), {}, values(f_), {}};
    for (int k = 0; k < m_; ++k) {
      for (int i = 0; i < n_; ++i) pass.Phi_q.push_back(Phi_q_(k, i));
    }
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j) pass.T.push_back(j <= i ? T_(i, j) : 0.0);
    }
    return true;
  }

  void predict() {
    const double h = settings_.step;
    const Vector difference = h * v_ + h * h / 2 * a_;
    q_ += difference;
    a_ = difference / scale_ - 4 / h * v_ - a_;
    v_ = 2 / h * difference - v_;
  }
  void evaluate_constraints() {
    mbs::evaluate_constraints(model_, 0.0, values(q_), {Phi_.data(), size(m_)});
    Phi_q_.setZero();
    for (const JacobianEntry& entry : jacobian(model_, 0.0, values(q_))) {
      Phi_q_(entry.row, entry.col) =
          kMistake == Mistake::half_jacobian ? entry.value / 2 : entry.value;
    }
  }
  void evaluate() {
    const double alpha = settings_.penalty;
    evaluate_constraints();
    if (kMistake == Mistake::lambda_first) lambda_ += alpha * Phi_;
    f_ = scale_ * (M_ * a_ + Phi_q_.transpose() * (lambda_ + alpha * Phi_) - Q_);
    T_ = M_ + scale_ * alpha * Phi_q_.transpose() * Phi_q_;
  }
  static std::vector<double> values(const Vector& x) { return {x.begin(), x.end()}; }
  static std::size_t size(Eigen::Index count) { return static_cast<std::size_t>(count); }

  const Model& model_;
  StepSettings settings_;
  Eigen::Index n_, m_;
  double scale_;  // dt^2/4
  Eigen::MatrixXd M_;
  Vector Q_, q_, v_, a_, lambda_;
  Vector Phi_ = Vector::Zero(m_), f_ = Vector::Zero(n_);
  Eigen::MatrixXd Phi_q_ = Eigen::MatrixXd::Zero(m_, n_), T_ = Eigen::MatrixXd::Zero(n_, n_);
  Eigen::LLT<Eigen::MatrixXd> factors_;
};

template <Mistake kMistake, bool kShows = true>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<Planted<kMistake, kShows>>(model, settings);
}

}  // namespace

std::vector<Variant> planted() {
  return {{"right", "no mistake", create<Mistake::none>},
          {"half_jacobian", "Phi_q without its factor 2", create<Mistake::half_jacobian>},
          {"half_mass", "M without its upper half", create<Mistake::half_mass>},
          {"lambda_first", "lambda before the residual", create<Mistake::lambda_first>},
          {"hidden_lambda_first", "the same, unseen", create<Mistake::lambda_first, false>},
          {"lambda_sign", "lambda - alpha Phi", create<Mistake::lambda_sign>},
          {"no_curvature", "a projected without (Phi_q)' v", create<Mistake::no_curvature>},
          {"always_both", "a is projected unasked", create<Mistake::always_both>}};
}

}  // namespace mbs::test
