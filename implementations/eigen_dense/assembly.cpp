// The residual, the tangent matrix and the right-hand sides of the projections, stored densely.
#ifdef __GNUC__  // GCC 12 warns wrongly about its own AVX-512 intrinsics (GCC bug 105593)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "assembly.hpp"

#include <algorithm>

namespace mbs::eigen_dense {

namespace {

/// Up to here Eigen's general product, which does both triangles, beats its rank-k update.
constexpr Eigen::Index kGeneralProductLimit = 28;

/// Depth of a rank-k update whose packed operands, depth×n, still fit Eigen's stack buffers.
Eigen::Index stack_depth(Eigen::Index variables) {
  const Eigen::Index limit = EIGEN_STACK_ALLOCATION_LIMIT / sizeof(double);
  return std::max<Eigen::Index>(8, limit / std::max<Eigen::Index>(1, variables) / 8 * 8);
}

}  // namespace

Assembly::Assembly(const Model& model, const StepSettings& settings, const Layout& layout)
    : variables_(model.variables()),
      penalty_(settings.penalty),
      scale_(settings.step * settings.step / 4),
      slice_depth_(stack_depth(variables_)),
      constraints_(model, layout),
      drivers_(model, layout),
      forces_(model, settings, layout),
      M_(Eigen::MatrixXd::Zero(variables_, variables_)),
      scaled_force_(scale_ * Eigen::Map<const Eigen::VectorXd>(model.force().data(), variables_)),
      multiplier_(Eigen::VectorXd::Zero(model.constraints())),
      acceleration_term_(Eigen::VectorXd::Zero(model.constraints())) {
  for (const MassEntry& entry : model.mass()) {
    M_(entry.row, entry.col) = M_(entry.col, entry.row) = entry.value;
  }
  if (model.linear_constraints().empty()) return;
  M_and_linear_ = M_;
  constraints_.add_linear_share(scale_ * penalty_, M_and_linear_);  // Eq. (5)
}

void Assembly::evaluate(const Eigen::VectorXd& q) {
  constraints_.evaluate(q);
  drivers_.subtract_values(constraints_.Phi());
}

void Assembly::residual(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                        const Eigen::VectorXd& a, const Eigen::VectorXd& lambda,
                        Eigen::VectorXd& rhs) {
  rhs = scaled_force_;
  drivers_.add_force(scale_, rhs);
  if (!forces_.empty()) forces_.evaluate(q, v, rhs);
  rhs.noalias() -= scale_ * (M_ * a);  // Eq. (3), by Eq. (2)
  if (Phi().size() == 0) return;
  multiplier_ = lambda + penalty_ * Phi();
  rhs.noalias() -= scale_ * (constraints_.jacobian_transposed() * multiplier_);
}

// A rank-k update deeper than slice_depth_ is done in slices of the constraints.
void Assembly::tangent(Eigen::MatrixXd& T) const {
  const Index depth = constraints_.quadratic();
  T = M_and_linear_.size() == 0 ? M_ : M_and_linear_;
  const double factor = scale_ * penalty_;
  const auto Jt = constraints_.jacobian_transposed();
  if (variables_ <= kGeneralProductLimit && depth > 0) {
    const auto quadratic = Jt.leftCols(depth);
    T.noalias() += factor * quadratic * quadratic.transpose();  // Eq. (5)
  } else {
    for (Index k = 0; k < depth; k += slice_depth_) {
      const auto slice = Jt.middleCols(k, std::min(slice_depth_, depth - k));
      T.selfadjointView<Eigen::Lower>().rankUpdate(slice, factor);  // Eq. (5)
    }
  }
  if (!forces_.empty()) forces_.add_tangent(T);
}

void Assembly::project_velocity(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                Eigen::VectorXd& rhs) {
  rhs.noalias() = M_ * v.head(variables_);  // Eq. (6)
  if (!forces_.empty()) forces_.add_product(v, rhs);
  if (drivers_.empty()) return;
  acceleration_term_.setZero();
  drivers_.add_velocity_term(q, acceleration_term_);
  rhs.noalias() -= scale_ * penalty_ * (constraints_.jacobian_transposed() * acceleration_term_);
}

void Assembly::project_acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                    const Eigen::VectorXd& a, Eigen::VectorXd& rhs) {
  rhs.noalias() = M_ * a;  // Eq. (6)
  if (!forces_.empty()) forces_.add_product(a, rhs);
  if (constraints_.quadratic() == 0 && drivers_.empty()) return;
  if (!drivers_.empty()) acceleration_term_.setZero();
  constraints_.velocity_term(v, acceleration_term_);
  if (!drivers_.empty()) drivers_.add_acceleration_term(q, acceleration_term_);
  rhs.noalias() -= scale_ * penalty_ * (constraints_.jacobian_transposed() * acceleration_term_);
}

}  // namespace mbs::eigen_dense
