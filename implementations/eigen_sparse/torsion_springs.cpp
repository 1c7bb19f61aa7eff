// Springs and dampers on angles, Eq. (11).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "forces.hpp"
#include "point_pairs.hpp"
#include "rotation.hpp"

namespace mbs::eigen_sparse {
namespace {

/// The gradients g are the rows of one matrix.
template <int kDimension>
class TorsionSprings final : public Force {
 public:
  explicit TorsionSprings(const ForceSetup& setup);
  void apply(const Vector& q, const Vector& v, Vector& force) override;
  void add_to_tangent(double* tangent) const override;
  void add_product(const Vector& x, Vector& result) override;

 private:
  struct Element {
    PointPairs pairs;
    Axis z;
    double stiffness, damping, angle;
    AddRows add;
    int first_value, first_slot;
  };

  std::vector<Element> elements_;
  RowSparseMatrix gradients_;
  Vector weight_;  // of g g^T
  Vector torque_;  // what acts against g: of the springs (N m), or as weight times g . x
  std::vector<int> slots_;
};

template <int kDimension>
TorsionSprings<kDimension>::TorsionSprings(const ForceSetup& setup)
    : gradients_(setup.model.torsion_springs().size(), setup.coordinates.variables()),
      weight_(gradients_.rows()),
      torque_(gradients_.rows()) {
  std::vector<int> columns;
  for (const TorsionSpring& spring : setup.model.torsion_springs()) {
    const auto first = columns.size();
    append_columns(setup.coordinates, ends_of(spring), columns);
    const auto row = std::span(columns).subspan(first);
    gradients_.outerIndexPtr()[elements_.size()] = static_cast<int>(first);
    weight_[elements_.size()] = weight_of(spring, setup.step);
    elements_.push_back({{setup.coordinates, ends_of(spring)},
                         axis_of(setup.coordinates, spring.axis),
                         spring.stiffness,
                         spring.damping,
                         spring.angle,
                         loop_for(setup.layout.triangle, static_cast<int>(row.size())),
                         static_cast<int>(first),
                         static_cast<int>(slots_.size())});
    append_slots(setup.layout, row, slots_);
  }
  gradients_.outerIndexPtr()[elements_.size()] = static_cast<int>(columns.size());
  gradients_.resizeNonZeros(static_cast<int>(columns.size()));
  std::copy(columns.begin(), columns.end(), gradients_.innerIndexPtr());
  std::fill_n(gradients_.valuePtr(), columns.size(), 0.0);
}

template <int kDimension>
void TorsionSprings<kDimension>::apply(const Vector& q, const Vector& v, Vector& force) {
  double u[kDimension], w[kDimension], u_rate[kDimension], w_rate[kDimension];
  double by_u[kDimension], by_w[kDimension];
  double* torque = torque_.data();
  for (const Element& spring : elements_) {
    spring.pairs.template differences<kDimension>(q.data(), u, w);
    spring.pairs.template differences<kDimension>(v.data(), u_rate, w_rate);
    turn<kDimension>(spring.z, q.data(), u, by_u);
    turn<kDimension>(spring.z, q.data(), w, by_w);
    const double angle = std::atan2(inner<kDimension>(by_u, w), inner<kDimension>(u, w));
    const double s = std::remainder(angle - spring.angle, 2.0 * std::numbers::pi);
    const double u_scale = -1.0 / inner<kDimension>(u, u), w_scale = 1.0 / inner<kDimension>(w, w);
    for (int axis = 0; axis < kDimension; ++axis) {
      by_u[axis] *= u_scale;
      by_w[axis] *= w_scale;
    }
    const double rate = inner<kDimension>(by_u, u_rate) + inner<kDimension>(by_w, w_rate);
    *torque++ = spring.stiffness * s + spring.damping * rate;
    spring.pairs.template write_row<kDimension>(by_u, by_w,
                                                gradients_.valuePtr() + spring.first_value);
  }
  force.noalias() -= gradients_.transpose() * torque_;  // Eq. (11)
}

template <int kDimension>
void TorsionSprings<kDimension>::add_to_tangent(double* tangent) const {
  const double* weight = weight_.data();
  for (const Element& spring : elements_) {
    spring.add(gradients_.valuePtr() + spring.first_value, slots_.data() + spring.first_slot, 1,
               *weight++, tangent);  // Eq. (5)
  }
}

template <int kDimension>
void TorsionSprings<kDimension>::add_product(const Vector& x, Vector& result) {
  torque_.noalias() = gradients_ * x;
  torque_.array() *= weight_.array();
  result.noalias() += gradients_.transpose() * torque_;  // Eq. (15)
}

}  // namespace

void append_torsion_springs(const ForceSetup& setup, Forces& forces) {
  if (setup.model.torsion_springs().empty()) return;
  if (setup.model.dimension() == 2) {
    forces.push_back(std::make_unique<TorsionSprings<2>>(setup));
  } else {
    forces.push_back(std::make_unique<TorsionSprings<3>>(setup));
  }
}

}  // namespace mbs::eigen_sparse
