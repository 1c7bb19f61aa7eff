// Evaluation of the constraints and refresh of the tangent matrix.
#include "assembly.hpp"

namespace mbs::eigen_superlu {

template <int kDimension, int kFreeEnds>
void Assembly::evaluate_distances(const double* q, int first, int last) {
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
void Assembly::evaluate_constraints(const double* q) {
  evaluate_distances<kDimension, 1>(q, 0, to_ground_);
  evaluate_distances<kDimension, 2>(q, to_ground_, distances_);
  double* row = jacobian_.valuePtr() + jacobian_.outerIndexPtr()[distances_];
  for (int k = distances_; k < quadratic_; ++k) {
    const Dot& dot = dots_[k - distances_];
    double ab[kDimension], cd[kDimension], product = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      ab[axis] = q[dot.ends[axis]] - q[dot.ends[kDimension + axis]];
      cd[axis] = q[dot.ends[2 * kDimension + axis]] - q[dot.ends[3 * kDimension + axis]];
      product += ab[axis] * cd[axis];
    }
    phi_[k] = product - value_[k];  // Eq. (7)
    for (int i = 0; i < dot.free_points; ++i) {
      for (int axis = 0; axis < kDimension; ++axis) {
        *row++ = dot.weights[2 * i] * cd[axis] + dot.weights[2 * i + 1] * ab[axis];
      }
    }
  }
}

void Assembly::evaluate(const Vector& q) {
  dimension_ == 2 ? evaluate_constraints<2>(q.data()) : evaluate_constraints<3>(q.data());
  if (const auto linear = jacobian_.rows() - quadratic_; linear > 0) {
    auto phi = phi_.tail(linear);
    phi = -value_.tail(linear);
    phi.noalias() += jacobian_.bottomRows(linear) * q.head(jacobian_.cols());  // Eq. (8)
  }
}

void Assembly::refresh_tangent() {
  Eigen::Map<Vector>(tangent_.valuePtr(), base_.size()) = base_;
  for (const Run& run : runs_) {  // Eq. (5)
    run.add(jacobian_.valuePtr() + run.first_value, slots_.data() + run.first_slot, run.count,
            penalty_, tangent_.valuePtr());
  }
}

template <int kDimension>
void Assembly::evaluate_velocities(const double* v, double* result) const {
  const int* a = ends_.data();
  for (int k = 0; k < distances_; ++k, a += 2 * kDimension) {
    double square = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double difference = v[a[axis]] - v[a[kDimension + axis]];
      square += difference * difference;
    }
    result[k] = 2.0 * square;  // Eq. (7)
  }
  for (int k = distances_; k < quadratic_; ++k) {
    const int* ends = dots_[k - distances_].ends;
    double product = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      product += (v[ends[axis]] - v[ends[kDimension + axis]]) *
                 (v[ends[2 * kDimension + axis]] - v[ends[3 * kDimension + axis]]);
    }
    result[k] = 2.0 * product;  // Eq. (7)
  }
}

void Assembly::velocity_terms(const Vector& v, Vector& result) const {
  dimension_ == 2 ? evaluate_velocities<2>(v.data(), result.data())
                  : evaluate_velocities<3>(v.data(), result.data());
  result.tail(result.size() - quadratic_).setZero();  // Eq. (8)
}

}  // namespace mbs::eigen_superlu
