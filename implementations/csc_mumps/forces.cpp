// Evaluation of the force elements, and their share of T's values.
#include "forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mbs::csc_mumps {

namespace {

template <int kDimension>
using Vector = std::array<double, kDimension>;

template <int kDimension>
Vector<kDimension> difference(const double* x, int a, int b) {
  Vector<kDimension> result;
  for (int axis = 0; axis < kDimension; ++axis) result[axis] = x[a + axis] - x[b + axis];
  return result;
}

template <std::size_t kDimension>
double dot(const std::array<double, kDimension>& u, const std::array<double, kDimension>& w) {
  double sum = 0.0;
  for (std::size_t axis = 0; axis < kDimension; ++axis) sum += u[axis] * w[axis];
  return sum;
}

/// z x w, z being the vector at `axis`; planar: (0, 0, 1).
Vector<2> turned(const double* /*q*/, int /*axis*/, const Vector<2>& w) { return {-w[1], w[0]}; }
Vector<3> turned(const double* q, int axis, const Vector<3>& w) {
  const double* z = q + axis;
  return {z[1] * w[2] - z[2] * w[1], z[2] * w[0] - z[0] * w[2], z[0] * w[1] - z[1] * w[0]};
}

/// The place in T's lower triangle of a row's pair (i, j), j <= i.
int pair(int i, int j) { return i * (i + 1) / 2 + j; }

}  // namespace

void Forces::evaluate(const double* q, const double* v, double* right) {
  const int* place = write_order_.data();
  if (dimension_ == 2) {
    place = evaluate_springs<2>(q, v, place, right);
    place = evaluate_torsion<2>(q, v, place, right);
    evaluate_couples<2>(q, place, right);
  } else {
    place = evaluate_springs<3>(q, v, place, right);
    place = evaluate_torsion<3>(q, v, place, right);
    evaluate_couples<3>(q, place, right);
  }
}

template <int kDimension>
const int* Forces::evaluate_springs(const double* q, const double* v, const int* place,
                                    double* right) {
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const SpringElement& spring = springs_[i];
    const auto d = difference<kDimension>(q, spring.a, spring.b);
    const auto rates = difference<kDimension>(v, spring.a, spring.b);
    const double length = std::sqrt(dot(d, d));
    const double inverse = length == 0.0 ? 0.0 : 1.0 / length;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double e = d[axis] * inverse;
      gradient_[*place++] = e;
      gradient_[*place++] = -e;
    }
    const double stretched = std::max(0.0, spring.stiffness * (1.0 - spring.length * inverse));
    transverse_[i] = quarter_ * stretched;
    rank_[i] = spring.weight - transverse_[i];
    const double rate = dot(d, rates) * inverse;
    apply(static_cast<int>(i), spring.stiffness * (length - spring.length) + spring.damping * rate,
          right);  // Eq. (11)
  }
  return place;
}

template <int kDimension>
const int* Forces::evaluate_torsion(const double* q, const double* v, const int* place,
                                    double* right) {
  int row = static_cast<int>(springs_.size());
  for (const TorsionElement& spring : torsion_springs_) {
    const auto u = difference<kDimension>(q, spring.a, spring.b);
    const auto w = difference<kDimension>(q, spring.c, spring.d);
    const auto across_u = turned(q, spring.axis, u);
    const auto across_w = turned(q, spring.axis, w);
    const double of_u = 1.0 / dot(u, u);
    const double of_w = 1.0 / dot(w, w);
    // Points may coincide, so shares are added up.
    std::fill(gradient_.begin() + start_[row], gradient_.begin() + start_[row + 1], 0.0);
    for (int axis = 0; axis < kDimension; ++axis) {
      gradient_[*place++] -= of_u * across_u[axis];
      gradient_[*place++] += of_u * across_u[axis];
      gradient_[*place++] += of_w * across_w[axis];
      gradient_[*place++] -= of_w * across_w[axis];
    }
    const double rate = of_w * dot(across_w, difference<kDimension>(v, spring.c, spring.d)) -
                        of_u * dot(across_u, difference<kDimension>(v, spring.a, spring.b));
    const double angle = std::atan2(dot(across_u, w), dot(u, w));
    const double turn = std::remainder(angle - spring.angle, 2.0 * std::numbers::pi);
    apply(row++, spring.stiffness * turn + spring.damping * rate, right);  // Eq. (11)
  }
  return place;
}

template <int kDimension>
void Forces::evaluate_couples(const double* q, const int* place, double* right) {
  int row = coupling_rows();
  for (const CoupleElement& couple : couples_) {
    const auto w = difference<kDimension>(q, couple.a, couple.b);
    const auto across = turned(q, couple.axis, w);
    const double of_w = 1.0 / dot(w, w);
    for (int axis = 0; axis < kDimension; ++axis) {
      gradient_[*place++] = of_w * across[axis];
      gradient_[*place++] = -of_w * across[axis];
    }
    apply(row++, -couple.torque, right);
  }
}

/// right += force g, which is -Q of the element.
void Forces::apply(int row, double force, double* right) const {
  for (int k = start_[row]; k < start_[row + 1]; ++k) right[column_[k]] += force * gradient_[k];
}

void Forces::add_to_tangent(const int* place, double* tangent) const {
  for (int row = 0; row < coupling_rows(); ++row) {
    const int count = start_[row + 1] - start_[row];
    const double* g = gradient_.data() + start_[row];
    if (row < static_cast<int>(springs_.size())) {
      const double amount = transverse_[row];
      for (int i = 0; i < count; ++i) tangent[place[pair(i, i)]] += amount;
      for (int i = dimension_; i < count; ++i) tangent[place[pair(i, i - dimension_)]] -= amount;
    }
    for (int i = 0; i < count; ++i) {
      const double factor = rank_[row] * g[i];
      for (int j = 0; j <= i; ++j) tangent[*place++] += factor * g[j];  // Eq. (5)
    }
  }
}

}  // namespace mbs::csc_mumps
