// Residual and derivative of both forms, and a start that fits them.
#include "ida_problem.hpp"

#include <Eigen/SparseLU>

namespace engines {

IdaProblem::IdaProblem(const mbs::Model& model, Settings& settings, double duration)
    : of_(model),
      ggl_(settings.choice("form", {"ggl", "baumgarte"}) == 0),
      n_(of_.n()),
      m_(of_.m()),
      q_(of_.start()),
      v_(of_.size(), 0.0),
      a_(of_.size(), 0.0),
      sum_(of_.size()),
      phi_(m_),
      rate_(m_),
      acceleration_(m_) {
  if (!ggl_) w_ = settings.number("rate", 20.0) / duration;
  std::ranges::copy(model.initial_velocity(), v_.begin());
  write(std::vector<double>(size()).data(), 1.0);
  matrix_.settle(size());
}

void IdaProblem::take(const double* y, const double* y_rate) {
  std::copy_n(y, n_, q_.begin());
  std::copy_n(y + n_, n_, v_.begin());
  std::copy_n(y_rate + n_, n_, a_.begin());
}

void IdaProblem::residual(const double* y, const double* y_rate, double* r) {
  take(y, y_rate);
  const double* lambda = y + 2 * n_;
  of_.constraints(q_.data(), v_.data(), a_.data(), phi_.data(), rate_.data(), acceleration_.data());
  std::ranges::fill(sum_, 0.0);
  if (ggl_) of_.add_reaction(q_.data(), lambda + m_, sum_.data());
  for (std::size_t i = 0; i < n_; ++i) r[i] = y_rate[i] - v_[i] + sum_[i];
  std::ranges::fill(sum_, 0.0);
  of_.add_inertia_and_force(q_.data(), a_.data(), sum_.data());
  of_.add_reaction(q_.data(), lambda, sum_.data());
  std::copy_n(sum_.begin(), n_, r + n_);
  double* rest = r + 2 * n_;
  for (std::size_t k = 0; k < m_; ++k) {
    if (ggl_) {
      rest[k] = phi_[k];
      rest[m_ + k] = rate_[k];
    } else {
      rest[k] = acceleration_[k] + 2 * w_ * rate_[k] + w_ * w_ * phi_[k];
    }
  }
}

void IdaProblem::derivative(const double* y, const double* y_rate, double c, double* values) {
  take(y, y_rate);
  matrix_.begin(values);
  write(y, c);
  matrix_.end();
}

void IdaProblem::write(const double* y, double c) {
  const double *lambda = y + 2 * n_, *mu = lambda + m_, *q = q_.data();
  for (std::size_t i = 0; i < n_; ++i) {
    matrix_.add(i, i, c);
    matrix_.add(i, n_ + i, -1.0);
  }
  of_.write_stiffness(q, {n_, 0}, matrix_);
  of_.write_reaction_change(lambda, {n_, 0}, matrix_);
  of_.write_mass(c, {n_, n_}, matrix_);
  of_.write_jacobian(q, 1.0, {n_, 2 * n_}, matrix_, true);
  const std::size_t rest = 2 * n_, second = rest + m_;
  if (ggl_) {
    of_.write_reaction_change(mu, {0, 0}, matrix_);
    of_.write_jacobian(q, 1.0, {0, second}, matrix_, true);
    of_.write_jacobian(q, 1.0, {rest, 0}, matrix_);
    of_.write_jacobian_change(v_.data(), 1.0, {second, 0}, matrix_);
    of_.write_jacobian(q, 1.0, {second, n_}, matrix_);
    return;
  }
  of_.write_jacobian_change(a_.data(), 1.0, {rest, 0}, matrix_);
  of_.write_jacobian_change(v_.data(), 2 * w_, {rest, 0}, matrix_);
  of_.write_jacobian(q, w_ * w_, {rest, 0}, matrix_);
  of_.write_jacobian(q, c + 2 * w_, {rest, n_}, matrix_);
  of_.write_jacobian_change(v_.data(), 2.0, {rest, n_}, matrix_);
}

void IdaProblem::write_start(SparseWriter& to) const {
  of_.write_mass(1.0, {0, 0}, to);
  of_.write_jacobian(q_.data(), 1.0, {0, n_}, to, true);
  of_.write_jacobian(q_.data(), 1.0, {n_, 0}, to);
}

void IdaProblem::start(double* y, double* y_rate) {
  std::fill_n(y, size(), 0.0);
  std::fill_n(y_rate, size(), 0.0);
  std::copy_n(q_.begin(), n_, y);
  std::copy_n(v_.begin(), n_, y + n_);
  std::copy_n(v_.begin(), n_, y_rate);
  // [M, Phi_q^T; Phi_q, 0] [a; lambda] = [Q; -(Phi_q)' v]; a is zero so far.
  SparseWriter to;
  write_start(to);
  to.settle(n_ + m_);
  std::vector<double> values(to.rows().size(), 0.0);
  to.begin(values.data());
  write_start(to);
  to.end();
  of_.constraints(q_.data(), v_.data(), a_.data(), phi_.data(), rate_.data(), acceleration_.data());
  std::ranges::fill(sum_, 0.0);
  of_.add_inertia_and_force(q_.data(), a_.data(), sum_.data());
  const auto order = static_cast<Eigen::Index>(n_ + m_);
  Eigen::VectorXd right(order);
  for (std::size_t i = 0; i < n_; ++i) right(static_cast<Eigen::Index>(i)) = -sum_[i];
  for (std::size_t k = 0; k < m_; ++k) right(static_cast<Eigen::Index>(n_ + k)) = -acceleration_[k];
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;
  const Matrix matrix =
      Eigen::Map<const Matrix>(order, order, static_cast<Eigen::Index>(values.size()),
                               to.starts().data(), to.rows().data(), values.data());
  Eigen::SparseLU<Matrix> factors(matrix);
  if (factors.info() != Eigen::Success) throw std::runtime_error("its start is singular");
  const Eigen::VectorXd found = factors.solve(right);
  std::copy_n(found.data(), n_, y_rate + n_);
  std::copy_n(found.data() + n_, m_, y + 2 * n_);
}

}  // namespace engines
