// What the equations need of M, the Jacobian and the forces, stored densely.
#include "assembly.hpp"

#include "rank_update.hpp"

namespace mbs::eigen_dense {

template <typename Scalar>
Assembly<Scalar>::Assembly(const Model& model, const StepSettings& settings, const Layout& layout)
    : variables_(model.variables()),
      penalty_(Scalar(settings.penalty)),
      scale_(Scalar(settings.step * settings.step / 4)),
      constraints_(model, layout),
      drivers_(model, layout),
      forces_(model, settings, layout),
      M_(Matrix::Zero(variables_, variables_)),
      scaled_force_(
          scale_ *
          Eigen::Map<const Eigen::VectorXd>(model.force().data(), variables_).cast<Scalar>()),
      multiplier_(Vector::Zero(model.constraints())),
      term_(Vector::Zero(model.constraints())) {
  for (const MassEntry& entry : model.mass()) {
    M_(entry.row, entry.col) = M_(entry.col, entry.row) = Scalar(entry.value);
  }
  if (model.linear_constraints().empty()) return;
  M_and_linear_ = M_;
  constraints_.add_linear_share(scale_ * penalty_, M_and_linear_);  // Eq. (5)
}

template <typename Scalar>
void Assembly<Scalar>::evaluate(const Vector& q, bool jacobian) {
  constraints_.evaluate(q, jacobian);
  drivers_.evaluate(q, constraints_.Phi());
}

template <typename Scalar>
void Assembly<Scalar>::scaled_force(const Vector& q, const Vector& v, Vector& rhs) {
  rhs = scaled_force_;
  drivers_.add_force(scale_, rhs);
  if (!forces_.empty()) forces_.evaluate(q, v, rhs);
}

template <typename Scalar>
void Assembly<Scalar>::residual(const Vector& q, const Vector& v, const Vector& a,
                                const Vector& lambda, Vector& rhs) {
  multiplier_ = lambda + penalty_ * Phi();
  plain_residual(q, v, a, multiplier_, rhs);
}

template <typename Scalar>
void Assembly<Scalar>::plain_residual(const Vector& q, const Vector& v, const Vector& a,
                                      const Vector& lambda, Vector& rhs) {
  scaled_force(q, v, rhs);
  rhs.noalias() -= scale_ * (M_ * a);  // Eq. (3), by Eq. (2)
  if (Phi().size() == 0) return;
  rhs.noalias() -= scale_ * (constraints_.jacobian_transposed() * lambda);
}

template <typename Scalar>
void Assembly<Scalar>::tangent(Matrix& T) const {
  T = M_and_linear_.size() == 0 ? M_ : M_and_linear_;
  const auto Jt = constraints_.jacobian_transposed();
  rank_update<Scalar>(Jt.leftCols(constraints_.quadratic()), scale_ * penalty_, T);  // Eq. (5)
  if (!forces_.empty()) forces_.add_tangent(T);
}

template <typename Scalar>
void Assembly<Scalar>::tangent(Eigen::MatrixXf& T, Eigen::MatrixXf& jacobian) const {
  T = (M_and_linear_.size() == 0 ? M_ : M_and_linear_).template cast<float>();
  const auto Jt = constraints_.jacobian_transposed();
  jacobian = Jt.leftCols(constraints_.quadratic()).template cast<float>();
  rank_update<float>(jacobian, float(scale_ * penalty_), T);  // Eq. (5)
  if (!forces_.empty()) forces_.add_tangent(T);
}

template <typename Scalar>
template <typename MatrixScalar>
void Assembly<Scalar>::leading(Eigen::MatrixX<MatrixScalar>& T) const {
  T = M_.template cast<MatrixScalar>();
  forces_.add_tangent(T);  // Eq. (12)
}

template <typename Scalar>
void Assembly<Scalar>::kept_leading_product(const Vector& x, Vector& y) const {
  y.noalias() = M_ * x;
  forces_.add_kept_product(x, y);
}

template <typename Scalar>
const Eigen::VectorX<Scalar>& Assembly<Scalar>::velocity_error(const Vector& v) {
  term_.setZero();
  if (!drivers_.empty()) drivers_.add_velocity_term(term_);
  constraints_.add_product(v, term_);
  return term_;
}

template <typename Scalar>
const Eigen::VectorX<Scalar>& Assembly<Scalar>::acceleration_term(const Vector& v) {
  term_.setZero();  // the rows of linear constraints are not written by the next line
  constraints_.velocity_term(v, term_);
  if (!drivers_.empty()) drivers_.add_acceleration_term(term_);
  return term_;
}

template <typename Scalar>
const Eigen::VectorX<Scalar>& Assembly<Scalar>::acceleration_error(const Vector& v,
                                                                   const Vector& a) {
  acceleration_term(v);
  constraints_.add_product(a, term_);
  return term_;
}

template class Assembly<double>;
template class Assembly<float>;
template void Assembly<double>::leading(Eigen::MatrixX<double>&) const;
template void Assembly<double>::leading(Eigen::MatrixX<float>&) const;
template void Assembly<float>::leading(Eigen::MatrixX<float>&) const;

}  // namespace mbs::eigen_dense
