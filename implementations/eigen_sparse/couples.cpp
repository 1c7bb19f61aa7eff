// Constant torques.
#include "forces.hpp"
#include "point_pairs.hpp"
#include "rotation.hpp"

namespace mbs::eigen_sparse {
namespace {

/// Couples with one or both ends free; the first end is. They have no share in C and K.
template <int kDimension>
class Couples final : public Force {
 public:
  explicit Couples(const ForceSetup& setup);
  void apply(const Vector& q, const Vector& v, Vector& force) override;
  void add_to_tangent(double*) const override {}
  void add_product(const Vector&, Vector&) override {}

 private:
  struct Element {
    double torque;
    Axis z;
    bool both_free;
    int a[kDimension] = {}, b[kDimension] = {};
  };
  std::vector<Element> elements_;
};

template <int kDimension>
Couples<kDimension>::Couples(const ForceSetup& setup) {
  for (const Couple& couple : setup.model.couples()) {
    const auto free = free_ones(setup.coordinates, ends_of(couple));
    if (free.empty()) continue;
    const int a = free[0], b = a == couple.a ? couple.b : couple.a;
    Element element{couple.torque, axis_of(setup.coordinates, couple.axis), free.size() == 2};
    for (int axis = 0; axis < kDimension; ++axis) {
      element.a[axis] = setup.coordinates.of_point(a, axis);
      element.b[axis] = setup.coordinates.of_point(b, axis);
    }
    elements_.push_back(element);
  }
}

template <int kDimension>
void Couples<kDimension>::apply(const Vector& q, const Vector&, Vector& force) {
  double w[kDimension], z_w[kDimension];
  for (const Element& couple : elements_) {
    for (int axis = 0; axis < kDimension; ++axis) w[axis] = q[couple.a[axis]] - q[couple.b[axis]];
    turn<kDimension>(couple.z, q.data(), w, z_w);
    const double scale = couple.torque / inner<kDimension>(w, w);
    for (int axis = 0; axis < kDimension; ++axis) {
      force[couple.a[axis]] += scale * z_w[axis];
      if (couple.both_free) force[couple.b[axis]] -= scale * z_w[axis];
    }
  }
}

}  // namespace

void append_couples(const ForceSetup& setup, Forces& forces) {
  if (setup.model.couples().empty()) return;
  if (setup.model.dimension() == 2) {
    forces.push_back(std::make_unique<Couples<2>>(setup));
  } else {
    forces.push_back(std::make_unique<Couples<3>>(setup));
  }
}

}  // namespace mbs::eigen_sparse
