// Springs and dampers along lines, Eq. (11).
#include <algorithm>
#include <cmath>

#include "forces.hpp"

namespace mbs::eigen_sparse {
namespace {

/// Springs with one or both ends free; the first end is.
template <int kDimension, int kFreeEnds, Triangle kTriangle>
class Springs final : public Force {
 public:
  Springs(const ForceSetup& setup, const std::vector<Spring>& springs);
  void apply(const Vector& q, const Vector& v, Vector& force) override;
  void add_to_tangent(double* tangent) const override;
  void add_product(const Vector& x, Vector& result) override;

 private:
  static constexpr int kWidth = kFreeEnds * kDimension;
  struct Element {
    double stiffness, damping, length;
    double along;         // weight of g g^T
    double across = 0.0;  // (dt^2/4) p of the last apply()
    double e[kDimension] = {};
    int a[kDimension] = {}, b[kDimension] = {};
  };

  double quarter_;  // dt^2/4
  std::vector<Element> elements_;
  std::vector<int> slots_;
};

template <int kDimension, int kFreeEnds, Triangle kTriangle>
Springs<kDimension, kFreeEnds, kTriangle>::Springs(const ForceSetup& setup,
                                                   const std::vector<Spring>& springs)
    : quarter_(0.25 * setup.step * setup.step) {
  std::vector<int> columns;
  for (const Spring& spring : springs) {
    const bool swapped = !setup.coordinates.is_free(spring.a);
    const int a = swapped ? spring.b : spring.a, b = swapped ? spring.a : spring.b;
    Element element{spring.stiffness, spring.damping, spring.length, weight_of(spring, setup.step)};
    for (int axis = 0; axis < kDimension; ++axis) {
      element.a[axis] = setup.coordinates.of_point(a, axis);
      element.b[axis] = setup.coordinates.of_point(b, axis);
    }
    elements_.push_back(element);
    columns.clear();
    append_columns(setup.coordinates, std::array<int, 2>{a, b}, columns);
    append_slots(setup.layout, columns, slots_);
  }
}

template <int kDimension, int kFreeEnds, Triangle kTriangle>
void Springs<kDimension, kFreeEnds, kTriangle>::apply(const Vector& q, const Vector& v,
                                                      Vector& force) {
  for (Element& s : elements_) {
    double square = 0.0, rate = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      s.e[axis] = q[s.a[axis]] - q[s.b[axis]];
      square += s.e[axis] * s.e[axis];
      rate += s.e[axis] * (v[s.a[axis]] - v[s.b[axis]]);
    }
    const double length = std::sqrt(square);
    const double inverse = length > 0.0 ? 1.0 / length : 0.0;
    const double tension = s.stiffness * (length - s.length) + s.damping * inverse * rate;
    s.across = quarter_ * std::max(0.0, s.stiffness * (1.0 - s.length * inverse));
    for (int axis = 0; axis < kDimension; ++axis) {
      s.e[axis] *= inverse;
      force[s.a[axis]] -= tension * s.e[axis];  // Eq. (11)
      if constexpr (kFreeEnds == 2) force[s.b[axis]] += tension * s.e[axis];
    }
  }
}

/// Blocks +-(along e e^T + across (I - e e^T)).
template <int kDimension, int kFreeEnds, Triangle kTriangle>
void Springs<kDimension, kFreeEnds, kTriangle>::add_to_tangent(double* tangent) const {
  const int* slots = slots_.data();
  for (const Element& s : elements_) {
    double block[kDimension][kDimension];
    for (int i = 0; i < kDimension; ++i) {
      for (int j = 0; j < kDimension; ++j) {
        block[i][j] = (s.along - s.across) * s.e[i] * s.e[j] + (i == j ? s.across : 0.0);
      }
    }
    for (int i = 0; i < kWidth; ++i) {
      const int end = kTriangle == Triangle::full ? kWidth : i + 1;
      for (int j = 0; j < end; ++j) {
        const double entry = block[i % kDimension][j % kDimension];
        tangent[*slots++] += (i < kDimension) == (j < kDimension) ? entry : -entry;  // Eq. (5)
      }
    }
  }
}

template <int kDimension, int kFreeEnds, Triangle kTriangle>
void Springs<kDimension, kFreeEnds, kTriangle>::add_product(const Vector& x, Vector& result) {
  for (const Element& s : elements_) {
    double d[kDimension], along = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      d[axis] = x[s.a[axis]];
      if constexpr (kFreeEnds == 2) d[axis] -= x[s.b[axis]];
      along += s.e[axis] * d[axis];
    }
    for (int axis = 0; axis < kDimension; ++axis) {
      const double entry = (s.along - s.across) * along * s.e[axis] + s.across * d[axis];
      result[s.a[axis]] += entry;  // Eq. (15)
      if constexpr (kFreeEnds == 2) result[s.b[axis]] -= entry;
    }
  }
}

template <int kDimension, int kFreeEnds>
std::unique_ptr<Force> make(const ForceSetup& setup, const std::vector<Spring>& springs) {
  if (setup.layout.triangle == Triangle::full) {
    return std::make_unique<Springs<kDimension, kFreeEnds, Triangle::full>>(setup, springs);
  }
  return std::make_unique<Springs<kDimension, kFreeEnds, Triangle::upper>>(setup, springs);
}

}  // namespace

void append_springs(const ForceSetup& setup, Forces& forces) {
  std::vector<Spring> by_free_ends[3];
  for (const Spring& spring : setup.model.springs()) {
    by_free_ends[free_ones(setup.coordinates, ends_of(spring)).size()].push_back(spring);
  }
  const bool planar = setup.model.dimension() == 2;
  if (const auto& springs = by_free_ends[1]; !springs.empty()) {
    forces.push_back(planar ? make<2, 1>(setup, springs) : make<3, 1>(setup, springs));
  }
  if (const auto& springs = by_free_ends[2]; !springs.empty()) {
    forces.push_back(planar ? make<2, 2>(setup, springs) : make<3, 2>(setup, springs));
  }
}

}  // namespace mbs::eigen_sparse
