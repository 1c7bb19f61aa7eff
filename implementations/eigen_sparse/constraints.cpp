// Evaluation of the constraints.
#include "constraints.hpp"

namespace mbs::eigen_sparse {

template <int kDimension, int kFreeEnds>
void Constraints::evaluate_distances(const double* q, int first, int last) {
  const int* a = ends_.data() + 2 * kDimension * first;
  double* row = jacobian_.valuePtr() + jacobian_.outerIndexPtr()[first];
  for (int k = first; k < last; ++k, a += 2 * kDimension, row += kFreeEnds * kDimension) {
    double square = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double difference = q[a[axis]] - q[a[kDimension + axis]];
      square += difference * difference;
      row[axis] = 2.0 * difference;
      if constexpr (kFreeEnds == 2) row[kDimension + axis] = -2.0 * difference;
    }
    phi_[k] = square - value_[k];  // Eq. (7)
  }
}

template <int kDimension>
void Constraints::evaluate_constraints(const double* q) {
  evaluate_distances<kDimension, 1>(q, 0, to_ground_);
  evaluate_distances<kDimension, 2>(q, to_ground_, distances_);
  double* row = jacobian_.valuePtr() + jacobian_.outerIndexPtr()[distances_];
  double u[kDimension], w[kDimension];
  for (int k = distances_; k < products_; ++k) {
    const PointPairs& pairs = dots_[k - distances_];
    pairs.differences<kDimension>(q, u, w);
    phi_[k] = inner<kDimension>(u, w) - value_[k];  // Eq. (7)
    row = pairs.write_row<kDimension>(w, u, row);
  }
  for (int k = products_; k < quadratic_; ++k) {
    const auto& [pairs, B] = bilinear_[k - products_];
    double B_w[kDimension], u_B[kDimension];
    pairs.template differences<kDimension>(q, u, w);
    multiply<kDimension>(B, w, B_w);
    multiply_transposed<kDimension>(B, u, u_B);
    phi_[k] = inner<kDimension>(u, B_w) - value_[k];  // Eq. (7)
    row = pairs.template write_row<kDimension>(B_w, u_B, row);
  }
}

void Constraints::evaluate(const Vector& q) {
  dimension_ == 2 ? evaluate_constraints<2>(q.data()) : evaluate_constraints<3>(q.data());
  if (const auto linear = jacobian_.rows() - quadratic_; linear > 0) {
    auto phi = phi_.tail(linear);
    phi = -value_.tail(linear);
    phi.noalias() += jacobian_.bottomRows(linear) * q.head(jacobian_.cols());  // Eq. (8)
  }
}

template <int kDimension>
void Constraints::evaluate_velocities(const double* v, double* result) const {
  const int* a = ends_.data();
  for (int k = 0; k < distances_; ++k, a += 2 * kDimension) {
    double square = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double difference = v[a[axis]] - v[a[kDimension + axis]];
      square += difference * difference;
    }
    result[k] = 2.0 * square;  // Eq. (7)
  }
  double u[kDimension], w[kDimension];
  for (int k = distances_; k < products_; ++k) {
    dots_[k - distances_].differences<kDimension>(v, u, w);
    result[k] = 2.0 * inner<kDimension>(u, w);  // Eq. (7)
  }
  for (int k = products_; k < quadratic_; ++k) {
    const auto& [pairs, B] = bilinear_[k - products_];
    double B_w[kDimension];
    pairs.template differences<kDimension>(v, u, w);
    multiply<kDimension>(B, w, B_w);
    result[k] = 2.0 * inner<kDimension>(u, B_w);  // Eq. (7)
  }
}

void Constraints::velocity_terms(const Vector& v, Vector& result) const {
  dimension_ == 2 ? evaluate_velocities<2>(v.data(), result.data())
                  : evaluate_velocities<3>(v.data(), result.data());
  result.tail(result.size() - quadratic_).setZero();  // Eq. (8)
}

template <int kDimension>
void Constraints::add_products(const double* x, const double* y, double* result) const {
  const double* row = jacobian_.valuePtr();
  const int *columns = jacobian_.innerIndexPtr(), *starts = jacobian_.outerIndexPtr();
  const auto add = [&](int width) {
    double sum = *y++;
    for (int i = 0; i < width; ++i) sum += row[i] * x[columns[i]];
    for (int i = 0; i < width; ++i) result[columns[i]] += row[i] * sum;
    row += width;
    columns += width;
  };
  for (int k = 0; k < to_ground_; ++k) add(kDimension);
  for (int k = to_ground_; k < distances_; ++k) add(2 * kDimension);
  for (int k = distances_; k < jacobian_.rows(); ++k) add(starts[k + 1] - starts[k]);
}

void Constraints::multiply_squared(const Vector& x, const Vector& y, Vector& result) const {
  result.setZero();
  dimension_ == 2 ? add_products<2>(x.data(), y.data(), result.data())
                  : add_products<3>(x.data(), y.data(), result.data());
}

}  // namespace mbs::eigen_sparse
