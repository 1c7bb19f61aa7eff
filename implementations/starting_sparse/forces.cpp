// Evaluation of the force elements, Eq. (11), and their entries in T.
#include "forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mbs::starting_sparse {
namespace {

template <int kDimension>
using Array = std::array<double, kDimension>;

template <int kDimension>
Array<kDimension> difference(const double* x, int a, int b) {
  Array<kDimension> result;
  for (int axis = 0; axis < kDimension; ++axis) result[axis] = x[a + axis] - x[b + axis];
  return result;
}

template <std::size_t kDimension>
double dot(const std::array<double, kDimension>& u, const std::array<double, kDimension>& w) {
  double sum = 0.0;
  for (std::size_t axis = 0; axis < kDimension; ++axis) sum += u[axis] * w[axis];
  return sum;
}

/// z x w; planar z = (0, 0, 1).
Array<2> turn(const double*, const Array<2>& w) { return {-w[1], w[0]}; }
Array<3> turn(const double* z, const Array<3>& w) {
  return {z[1] * w[2] - z[2] * w[1], z[2] * w[0] - z[0] * w[2], z[0] * w[1] - z[1] * w[0]};
}

}  // namespace

void Forces::add_forces(const double* q, const double* v, double* right) {
  magnitude_ = 0.0;
  if (dimension_ == 2) {
    evaluate_springs<2>(q, v, right);
    evaluate_torsions<2>(q, v, right);
    evaluate_couples<2>(q, right);
  } else {
    evaluate_springs<3>(q, v, right);
    evaluate_torsions<3>(q, v, right);
    evaluate_couples<3>(q, right);
  }
}

bool Forces::is_finite() const { return std::isfinite(magnitude_); }

void Forces::assemble(double* entries) const {
  for (const SpringElement& spring : springs_) {
    const auto& sign = spring.ends.sign;
    const double extra = spring.along - spring.across;
    for_each_entry(spring.ends.count, [&](int s, int i, int r, int j) {
      const double across = i == j ? spring.across : 0.0;
      const double along = extra * spring.direction[i] * spring.direction[j];
      *entries++ = sign[s] * sign[r] * (across + along);  // Eq. (5)
    });
  }
  for (const TorsionElement& torsion : torsions_) {
    for_each_entry(torsion.count, [&](int s, int i, int r, int j) {
      *entries++ = torsion.weight * torsion.gradient[s][i] * torsion.gradient[r][j];  // Eq. (5)
    });
  }
}

template <int kDimension>
void Forces::evaluate_springs(const double* q, const double* v, double* right) {
  for (SpringElement& spring : springs_) {
    const auto d = difference<kDimension>(q, spring.a, spring.b);
    const auto rate = difference<kDimension>(v, spring.a, spring.b);
    const double length = std::sqrt(dot(d, d));
    const double inverse = length > 0.0 ? 1.0 / length : 0.0 * length;  // keeps NaN
    double length_rate = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      spring.direction[axis] = d[axis] * inverse;
      length_rate += spring.direction[axis] * rate[axis];
    }
    const double p = std::max(0.0, spring.stiffness * (1.0 - spring.length * inverse));
    spring.along = half_step_ * spring.damping + weight_ * spring.stiffness;
    spring.across = weight_ * p;
    const double force = spring.stiffness * (length - spring.length) + spring.damping * length_rate;
    magnitude_ += std::abs(force);
    for (int s = 0; s < spring.ends.count; ++s) {
      double* to = right + spring.ends.column[s];
      const double factor = -weight_ * force * spring.ends.sign[s];
      for (int axis = 0; axis < kDimension; ++axis) to[axis] += factor * spring.direction[axis];
    }  // Eq. (11)
  }
}

template <int kDimension>
void Forces::evaluate_torsions(const double* q, const double* v, double* right) {
  for (TorsionElement& torsion : torsions_) {
    const auto& [a, b, c, d] = torsion.point;
    const auto u = difference<kDimension>(q, a, b), w = difference<kDimension>(q, c, d);
    const auto u_turned = turn(q + torsion.axis, u), w_turned = turn(q + torsion.axis, w);
    const double by_u = 1.0 / dot(u, u), by_w = 1.0 / dot(w, w);
    const auto u_rate = difference<kDimension>(v, a, b), w_rate = difference<kDimension>(v, c, d);
    const double rate = by_w * dot(w_turned, w_rate) - by_u * dot(u_turned, u_rate);
    const double angle = std::atan2(dot(u_turned, w), dot(u, w));
    const double turned = std::remainder(angle - torsion.angle, 2.0 * std::numbers::pi);

    const auto& [to_a, to_b, to_c, to_d] = torsion.slot;
    auto& gradient = torsion.gradient;
    gradient = {};
    for (int axis = 0; axis < kDimension; ++axis) {
      const double at_a = -by_u * u_turned[axis], at_c = by_w * w_turned[axis];
      gradient[to_a][axis] += at_a;
      gradient[to_b][axis] -= at_a;
      gradient[to_c][axis] += at_c;
      gradient[to_d][axis] -= at_c;
    }
    torsion.weight = half_step_ * torsion.damping + weight_ * torsion.stiffness;
    const double torque = torsion.stiffness * turned + torsion.damping * rate;
    magnitude_ += std::abs(torque) + by_u + by_w;
    for (int s = 0; s < torsion.count; ++s) {
      double* to = right + torsion.column[s];
      for (int axis = 0; axis < kDimension; ++axis) {
        to[axis] -= weight_ * torque * gradient[s][axis];  // Eq. (11)
      }
    }
  }
}

template <int kDimension>
void Forces::evaluate_couples(const double* q, double* right) {
  for (const CoupleElement& couple : couples_) {
    const auto w = difference<kDimension>(q, couple.a, couple.b);
    const auto w_turned = turn(q + couple.axis, w);
    const double factor = weight_ * couple.torque / dot(w, w);
    magnitude_ += std::abs(factor);
    for (int s = 0; s < couple.ends.count; ++s) {
      double* to = right + couple.ends.column[s];
      for (int axis = 0; axis < kDimension; ++axis) {
        to[axis] += couple.ends.sign[s] * factor * w_turned[axis];
      }
    }
  }
}

}  // namespace mbs::starting_sparse
