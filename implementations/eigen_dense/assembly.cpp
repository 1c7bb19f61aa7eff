// Dense storage of M, Phi and Phi_q; the residual and the tangent matrix built from them.
#ifdef __GNUC__  // GCC 12 warns wrongly about its own AVX-512 intrinsics (GCC bug 105593)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "assembly.hpp"

#include <algorithm>

namespace mbs::eigen_dense {

namespace {

/// Up to here Eigen's general product, which does both triangles, beats its rank-k update.
constexpr Eigen::Index kGeneralProductLimit = 28;

/// The components of r_a − r_b.
template <int dimension>
Eigen::Matrix<double, dimension, 1> difference(const double* r, Eigen::Index a, Eigen::Index b) {
  using Vector = Eigen::Matrix<double, dimension, 1>;
  return Eigen::Map<const Vector>(r + a) - Eigen::Map<const Vector>(r + b);
}

/// Depth of a rank-k update whose packed operands, depth×n, still fit Eigen's stack buffers.
Eigen::Index stack_depth(Eigen::Index variables) {
  const Eigen::Index limit = EIGEN_STACK_ALLOCATION_LIMIT / sizeof(double);
  return std::max<Eigen::Index>(8, limit / std::max<Eigen::Index>(1, variables) / 8 * 8);
}

}  // namespace

Assembly::Assembly(const Model& model, const StepSettings& settings)
    : variables_(model.variables()),
      constraints_(model.constraints()),
      dimension_(model.dimension()),
      penalty_(settings.penalty),
      scale_(settings.step * settings.step / 4),
      slice_depth_(stack_depth(variables_)),
      M_(Eigen::MatrixXd::Zero(variables_, variables_)),
      scaled_force_(scale_ * Eigen::Map<const Eigen::VectorXd>(model.force().data(), variables_)),
      jacobian_(Eigen::VectorXd::Zero(variables_ * constraints_ + dimension_)),
      Phi_(Eigen::VectorXd::Zero(constraints_)),
      multiplier_(Eigen::VectorXd::Zero(constraints_)),
      velocity_term_(Eigen::VectorXd::Zero(constraints_)) {
  for (const MassEntry& entry : model.mass()) {
    M_(entry.row, entry.col) = M_(entry.col, entry.row) = entry.value;
  }
  lower_points(model);
  Index row = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) lower_dot(constraint, row++);
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    lower_linear(constraint, row++);
  }
}

void Assembly::lower_points(const Model& model) {
  extended_size_ = variables_;
  for (const Point& point : model.points()) {
    point_start_.push_back(point.is_fixed() ? extended_size_ : point.offset);
    if (point.is_fixed()) extended_size_ += dimension_;
  }
}

Assembly::Index Assembly::jacobian_position(int point, Index row) const {
  const Index start = point_start_[point];
  return start < variables_ ? row * variables_ + start : variables_ * constraints_;
}

void Assembly::lower_dot(const DotConstraint& constraint, Index row) {
  const auto [a, b, c, d, value, name] = constraint;
  if (a == c && b == d) {
    distances_.push_back({point_start_[a], point_start_[b], jacobian_position(a, row),
                          jacobian_position(b, row), row, value});
    return;
  }
  Dot dot{point_start_[a], point_start_[b], point_start_[c], point_start_[d], {}, row, value};
  const Index scratch = variables_ * constraints_;
  const std::array<int, 4> points{a, b, c, d};
  for (std::size_t k = 0; k < points.size(); ++k) {
    const int point = points[k];
    const bool repeated =
        std::find(points.begin(), points.begin() + k, point) != points.begin() + k;
    const Index to = jacobian_position(point, row);
    dot.slots[k] = {scratch, 0.0, 0.0};
    if (repeated || to == scratch) continue;
    dot.slots[k] = {to, double(point == c) - double(point == d),
                    double(point == a) - double(point == b)};
  }
  dots_.push_back(dot);
}

void Assembly::lower_linear(const LinearConstraint& constraint, Index row) {
  const Index begin = static_cast<Index>(terms_.size());
  terms_.insert(terms_.end(), constraint.terms.begin(), constraint.terms.end());
  linears_.push_back({begin, static_cast<Index>(terms_.size()), row, constraint.value});
  for (const auto& [coordinate, coefficient] : constraint.terms) {
    jacobian_[row * variables_ + coordinate] = coefficient;  // Eq. (8), once and for all
  }
}

Eigen::VectorXd Assembly::extended_position(const Model& model) const {
  Eigen::VectorXd q(extended_size_);
  for (std::size_t k = 0; k < point_start_.size(); ++k) {
    std::copy_n(model.points()[k].position.begin(), dimension_, q.data() + point_start_[k]);
  }
  return q;
}

template <int dimension>
void Assembly::evaluate_quadratic(const double* q) {
  using Vector = Eigen::Matrix<double, dimension, 1>;
  double* const jacobian = jacobian_.data();
  double* const Phi = Phi_.data();
  for (const Distance& distance : distances_) {  // Eq. (7) with a = c, b = d
    const Vector ab = difference<dimension>(q, distance.a, distance.b);
    Phi[distance.row] = ab.squaredNorm() - distance.value;
    Eigen::Map<Vector>(jacobian + distance.to_a) = 2.0 * ab;
    Eigen::Map<Vector>(jacobian + distance.to_b) = -2.0 * ab;
  }
  for (const Dot& dot : dots_) {  // Eq. (7)
    const Vector ab = difference<dimension>(q, dot.a, dot.b);
    const Vector cd = difference<dimension>(q, dot.c, dot.d);
    Phi[dot.row] = ab.dot(cd) - dot.value;
    for (const Dot::Slot& slot : dot.slots) {
      Eigen::Map<Vector>(jacobian + slot.to) = slot.ab * ab + slot.cd * cd;
    }
  }
}

void Assembly::evaluate(const Eigen::VectorXd& q) {
  dimension_ == 2 ? evaluate_quadratic<2>(q.data()) : evaluate_quadratic<3>(q.data());
  for (const Linear& linear : linears_) {  // Eq. (8)
    double sum = -linear.value;
    for (Index k = linear.begin; k < linear.end; ++k) {
      sum += terms_[k].coefficient * q[terms_[k].coordinate];
    }
    Phi_[linear.row] = sum;
  }
}

void Assembly::residual(const Eigen::VectorXd& a, const Eigen::VectorXd& lambda,
                        Eigen::VectorXd& rhs) {
  rhs = scaled_force_;
  rhs.noalias() -= scale_ * (M_ * a);  // Eq. (3), by Eq. (2)
  if (constraints_ == 0) return;
  multiplier_ = lambda + penalty_ * Phi_;
  rhs.noalias() -= scale_ * (jacobian_transposed() * multiplier_);
}

// A rank-k update deeper than slice_depth_ is done in slices of the constraints.
void Assembly::tangent(Eigen::MatrixXd& T) const {
  T = M_;
  const double factor = scale_ * penalty_;
  const auto Jt = jacobian_transposed();
  if (variables_ <= kGeneralProductLimit && constraints_ > 0) {
    T.noalias() += factor * Jt * Jt.transpose();  // Eq. (5)
    return;
  }
  for (Index k = 0; k < constraints_; k += slice_depth_) {
    const auto slice = Jt.middleCols(k, std::min(slice_depth_, constraints_ - k));
    T.selfadjointView<Eigen::Lower>().rankUpdate(slice, factor);  // Eq. (5)
  }
}

template <int dimension>
void Assembly::evaluate_velocity_term(const double* v) {
  double* const term = velocity_term_.data();
  for (const Distance& distance : distances_) {  // Eq. (7)
    term[distance.row] = 2.0 * difference<dimension>(v, distance.a, distance.b).squaredNorm();
  }
  for (const Dot& dot : dots_) {
    term[dot.row] =
        2.0 * difference<dimension>(v, dot.a, dot.b).dot(difference<dimension>(v, dot.c, dot.d));
  }
}

void Assembly::project_velocity(const Eigen::VectorXd& v, Eigen::VectorXd& rhs) const {
  rhs.noalias() = M_ * v.head(variables_);  // Eq. (6)
}

void Assembly::project_acceleration(const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                                    Eigen::VectorXd& rhs) {
  rhs.noalias() = M_ * a;  // Eq. (6)
  if (distances_.empty() && dots_.empty()) return;
  dimension_ == 2 ? evaluate_velocity_term<2>(v.data()) : evaluate_velocity_term<3>(v.data());
  rhs.noalias() -= scale_ * penalty_ * (jacobian_transposed() * velocity_term_);
}

}  // namespace mbs::eigen_dense
