// Evaluates the elements and adds them where they belong.
#include "forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mbs::starting_dense {

Forces::Forces(const Model& model, const Layout& layout, double step)
    : dimension_(layout.dimension), half_step_(0.5 * step), quarter_(0.25 * step * step) {
  for (const Spring& spring : model.springs()) {
    add_element(layout, {spring.a, spring.b, spring.a, spring.a},
                {.k = spring.stiffness, .c = spring.damping, .rest = spring.length});
  }
  springs_end_ = elements_.size();
  for (const TorsionSpring& spring : model.torsion_springs()) {
    add_element(layout, {spring.a, spring.b, spring.c, spring.d},
                {.k = spring.stiffness,
                 .c = spring.damping,
                 .rest = spring.angle,
                 .axis = layout.axis(spring.axis)});
  }
  torsions_end_ = elements_.size();
  for (const Couple& couple : model.couples()) {
    add_element(layout, {couple.a, couple.b, couple.a, couple.a},
                {.axis = layout.axis(couple.axis), .force = -couple.torque});
  }
}

void Forces::add_element(const Layout& layout, const std::array<int, 4>& points, Element element) {
  std::transform(points.begin(), points.end(), element.at.begin(),
                 [&](int point) { return layout.at[point]; });
  element.ends_begin = static_cast<int>(ends_.size());
  for (const Share& share : layout.shares(points, layout.variables)) {
    ends_.push_back({share.at, share.ab, share.cd, {}});
  }
  element.ends_end = static_cast<int>(ends_.size());
  elements_.push_back(element);
}

void Forces::evaluate(const Vector& q, const Vector& v) {
  std::size_t i = 0;
  for (; i < springs_end_; ++i) evaluate_spring(elements_[i], q, v);
  for (; i < torsions_end_; ++i) evaluate_torsion(elements_[i], q, v);
  for (; i < elements_.size(); ++i) evaluate_couple(elements_[i], q);
}

void Forces::evaluate_spring(Element& spring, const Vector& q, const Vector& v) {
  const auto [a, b, c, d] = spring.at;
  const Vector3 difference_ab = difference(q, a, b, dimension_);
  const double length = std::sqrt(dot(difference_ab, difference_ab));
  const double inverse = length > 0.0 ? 1.0 / length : 0.0;
  const Vector3 e = scaled(inverse, difference_ab);
  const double rate = dot(e, difference(v, a, b, dimension_));
  spring.force = spring.k * (length - spring.rest) + spring.c * rate;  // Eq. (11)
  const double p = std::max(0.0, spring.k * (1.0 - spring.rest * inverse));
  spring.isotropic = quarter_ * p;
  spring.rank_one = half_step_ * spring.c + quarter_ * spring.k - spring.isotropic;
  set_gradient(spring, e, {});
}

void Forces::evaluate_torsion(Element& torsion, const Vector& q, const Vector& v) {
  const auto [a, b, c, d] = torsion.at;
  const Vector3 z{q[torsion.axis], q[torsion.axis + 1], q[torsion.axis + 2]};
  const Vector3 u = difference(q, a, b, dimension_);
  const Vector3 w = difference(q, c, d, dimension_);
  const double angle = std::atan2(dot(z, cross(u, w)), dot(u, w));
  const Vector3 by_u = scaled(-1.0 / dot(u, u), cross(z, u));
  const Vector3 by_w = scaled(1.0 / dot(w, w), cross(z, w));
  const double rate =
      dot(by_u, difference(v, a, b, dimension_)) + dot(by_w, difference(v, c, d, dimension_));
  const double turned = std::remainder(angle - torsion.rest, 2.0 * std::numbers::pi);
  torsion.force = torsion.k * turned + torsion.c * rate;  // Eq. (11)
  torsion.rank_one = half_step_ * torsion.c + quarter_ * torsion.k;
  set_gradient(torsion, by_u, by_w);
}

void Forces::evaluate_couple(const Element& couple, const Vector& q) {
  const Vector3 z{q[couple.axis], q[couple.axis + 1], q[couple.axis + 2]};
  const Vector3 w = difference(q, couple.at[0], couple.at[1], dimension_);
  set_gradient(couple, scaled(1.0 / dot(w, w), cross(z, w)), {});
}

void Forces::set_gradient(const Element& element, const Vector3& by_ab, const Vector3& by_cd) {
  for (int k = element.ends_begin; k < element.ends_end; ++k) {
    End& end = ends_[k];
    for (int x = 0; x < dimension_; ++x) end.g[x] = end.ab * by_ab[x] + end.cd * by_cd[x];
  }
}

void Forces::subtract_from(Vector& right) const {
  for (const Element& element : elements_) {
    for (int k = element.ends_begin; k < element.ends_end; ++k) {
      const End& end = ends_[k];
      for (int x = 0; x < dimension_; ++x) right[end.at + x] += element.force * end.g[x];
    }
  }
}

void Forces::add_to(Matrix& tangent) const {
  for (std::size_t i = 0; i < torsions_end_; ++i) {
    const Element& element = elements_[i];
    for (int col = element.ends_begin; col < element.ends_end; ++col) {
      for (int row = element.ends_begin; row < element.ends_end; ++row) {
        add_block(element, ends_[row], ends_[col], tangent);
      }
    }
  }
}

void Forces::add_block(const Element& element, const End& row, const End& col,
                       Matrix& tangent) const {
  for (int x = 0; x < dimension_; ++x) {
    double* column = tangent.column(col.at + x) + row.at;
    const double factor = element.rank_one * col.g[x];
    for (int y = 0; y < dimension_; ++y) column[y] += factor * row.g[y];
    column[x] += element.isotropic * row.ab * col.ab;
  }
}

}  // namespace mbs::starting_dense
