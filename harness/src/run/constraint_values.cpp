// Eq. (7) from a list, or all equations from the model.
#include "run/constraint_values.hpp"

#include "model_math/kinematics.hpp"
#include "model_math/vector3.hpp"

namespace mbs {

ConstraintValues::ConstraintValues(const Model& model) : model_(&model) {
  if (is_driven(model) ||
      model.dot_constraints().size() != static_cast<std::size_t>(model.constraints()))
    return;
  const auto place_of = [&](int index) {
    const Point& point = model.points()[static_cast<std::size_t>(index)];
    if (!point.is_fixed()) return point.offset;
    const int place = -1 - static_cast<int>(fixed_.size());
    fixed_.insert(fixed_.end(), point.position.begin(), point.position.end());
    return place;
  };
  for (const DotConstraint& c : model.dot_constraints()) {
    rows_.push_back(
        {{place_of(c.a), place_of(c.b), place_of(c.c), place_of(c.d)}, c.value, c.is_distance()});
  }
}

template <bool kSpatial>
void ConstraintValues::evaluate_rows(const double* q, double* phi) const {
  const double* const fixed = fixed_.data();
  const auto difference = [q, fixed](int a, int b) {
    const double* const x = a < 0 ? fixed - 1 - a : q + a;
    const double* const y = b < 0 ? fixed - 1 - b : q + b;
    return Vector3{x[0] - y[0], x[1] - y[1], kSpatial ? x[2] - y[2] : 0.0};
  };
  for (const Row& row : rows_) {
    const auto [a, b, c, d] = row.points;
    const Vector3 u = difference(a, b);
    *phi++ = dot(u, row.is_distance ? u : difference(c, d)) - row.value;
  }
}

void ConstraintValues::evaluate(double t, std::span<const double> q, std::span<double> phi) const {
  if (rows_.empty() || q.size() != static_cast<std::size_t>(model_->variables())) {
    evaluate_constraints(*model_, t, q, phi);  // refuses another size
  } else if (model_->dimension() == 3) {
    evaluate_rows<true>(q.data(), phi.data());
  } else {
    evaluate_rows<false>(q.data(), phi.data());
  }
}

}  // namespace mbs
