// Springs, laws and couples; equations are those of paper/README.md.
#include "elements.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mbs::csc_ldl {
namespace {

template <int dimension>
using Components = std::array<double, dimension>;

template <std::size_t dimension>
double dot(const std::array<double, dimension>& a, const std::array<double, dimension>& b) {
  double sum = 0.0;
  for (std::size_t c = 0; c < dimension; ++c) sum += a[c] * b[c];
  return sum;
}

/// z x u; planar: z = (0, 0, 1).
Components<2> turned(const Components<2>& /*z*/, const Components<2>& u) { return {-u[1], u[0]}; }
Components<3> turned(const Components<3>& z, const Components<3>& u) {
  return {z[1] * u[2] - z[2] * u[1], z[2] * u[0] - z[0] * u[2], z[0] * u[1] - z[1] * u[0]};
}

template <int dimension>
Components<dimension> difference(const Group& group, const double* q, int vector, int k) {
  Components<dimension> u;
  for (int c = 0; c < dimension; ++c) u[c] = group.difference(q, vector * dimension + c, k);
  return u;
}

template <int dimension>
Components<dimension> axis_of(const std::array<int, 3>& places, const double* q) {
  if constexpr (dimension == 2) {
    return {};
  } else {
    return {q[places[0]], q[places[1]], q[places[2]]};
  }
}

template <class List>
int length(const List& list) {
  return static_cast<int>(list.size());
}

}  // namespace

void Elements::Family::resize() {
  law_factor.resize(laws.size());
  for (std::vector<double>* each : {&s, &rate, &force, &slope}) each->resize(group.count);
}

void Elements::Family::drive(double t) {
  for (std::size_t k = 0; k < laws.size(); ++k) law_factor[k] = laws[k]->factor.at(t).value;
}

Elements::Elements(const Model& model, const Coordinates& at, double step)
    : dt_2_(step / 2), dt2_4_(step * step / 4) {
  const auto axis = [&](int point) {
    return point < 0 ? std::array<int, 3>{} : std::array{at(point, 0), at(point, 1), at(point, 2)};
  };
  lines_.group = Group(length(model.springs()) + length(model.force_laws()), 1, at);
  int line = 0;
  for (const mbs::Spring& spring : model.springs()) {
    lines_.group.set_points(line++, 0, spring.a, spring.b, at);
    lines_.springs.push_back({spring.stiffness, spring.damping, spring.length});
  }
  for (const ForceLaw& law : model.force_laws()) {
    lines_.group.set_points(line++, 0, law.a, law.b, at);
    lines_.laws.push_back(&law.law);
  }

  angles_.group = Group(length(model.torsion_springs()) + length(model.torque_laws()), 2, at);
  const auto add_angle = [&](const auto& element) {
    angles_.group.set_points(length(angle_axis_), 0, element.a, element.b, at);
    angles_.group.set_points(length(angle_axis_), 1, element.c, element.d, at);
    angle_axis_.push_back(axis(element.axis));
  };
  for (const TorsionSpring& spring : model.torsion_springs()) {
    add_angle(spring);
    angles_.springs.push_back({spring.stiffness, spring.damping, spring.angle});
  }
  for (const TorqueLaw& law : model.torque_laws()) {
    add_angle(law);
    angles_.laws.push_back(&law.law);
  }

  couples_ = Group(length(model.couples()), 1, at);
  for (const Couple& couple : model.couples()) {
    couples_.set_points(length(torque_), 0, couple.a, couple.b, at);
    couple_axis_.push_back(axis(couple.axis));
    torque_.push_back(couple.torque);
  }

  for (Group* group : {&lines_.group, &angles_.group, &couples_}) {
    group->first_force = force_parts_;
    force_parts_ += group->force_parts();
  }
  angles_.group.first_matrix = lines_.group.matrix_parts();
  lines_.resize();
  angles_.resize();
  geometric_.resize(lines_.group.count);
  drive(0.0);  // of constant factors, once
}

void Elements::visit_forces(const std::function<void(int i, int part)>& visit) const {
  for (const Group* group : {&lines_.group, &angles_.group, &couples_}) {
    for (int k = 0; k < group->count; ++k) {
      for (const Group::End& end : group->ends(k)) visit(end.variable, group->force_part(k, end));
    }
  }
}

void Elements::visit_products(const std::function<void(int i, int j, int part)>& visit) const {
  lines_.group.visit_products(visit);
  angles_.group.visit_products(visit);
}

void Elements::drive(double t) {
  lines_.drive(t);
  angles_.drive(t);
}

void Elements::evaluate(const double* q, const double* v, double* force_parts,
                        double* matrix_parts) {
  if (lines_.group.dimension() == 2) {
    evaluate_geometry<2>(q);
  } else {
    evaluate_geometry<3>(q);
  }
  for (Family* family : {&lines_, &angles_}) {
    if (family->group.count == 0) continue;
    std::ranges::fill(family->rate, 0.0);
    family->group.add_contracted(v, family->rate.data());
    evaluate_forces(*family, family == &lines_);
    family->group.write_forces([family](int k) { return family->force[k]; }, force_parts);
    family->group.write_products([family](int k) { return family->slope[k]; }, matrix_parts);
  }
  // (dt^2/4) p I of lines, beside the products.
  const int count = lines_.group.count;
  for (int c = 0; c < lines_.group.components; ++c) {
    double* part = matrix_parts + c * (c + 3) * count;
    for (int k = 0; k < count; ++k) {
      part[k] += geometric_[k];
      part[count + k] -= geometric_[k];
    }
  }
  couples_.write_forces([](int) { return 1.0; }, force_parts);
}

// s with its gradient, and forces of couples.
template <int dimension>
void Elements::evaluate_geometry(const double* q) {
  Group& lines = lines_.group;
  for (int k = 0; k < lines.count; ++k) {
    const Components<dimension> d = difference<dimension>(lines, q, 0, k);
    const double L = std::sqrt(dot(d, d)), inverse = L > 0.0 ? 1 / L : 0.0;
    for (int c = 0; c < dimension; ++c) lines.gradient[c * lines.count + k] = d[c] * inverse;
    lines_.s[k] = L;
  }
  Group& angles = angles_.group;
  for (int k = 0; k < angles.count; ++k) {
    const Components<dimension> u = difference<dimension>(angles, q, 0, k),
                                w = difference<dimension>(angles, q, 1, k),
                                z = axis_of<dimension>(angle_axis_[k], q), z_u = turned(z, u),
                                z_w = turned(z, w);
    const double u_u = dot(u, u), w_w = dot(w, w);
    for (int c = 0; c < dimension; ++c) {
      angles.gradient[c * angles.count + k] = -z_u[c] / u_u;
      angles.gradient[(dimension + c) * angles.count + k] = z_w[c] / w_w;
    }
    angles_.s[k] = std::atan2(dot(z_u, w), dot(u, w));  // z . (u x w) = (z x u) . w
  }
  for (int k = 0; k < couples_.count; ++k) {
    const Components<dimension> w = difference<dimension>(couples_, q, 0, k),
                                z_w = turned(axis_of<dimension>(couple_axis_[k], q), w);
    const double factor = -torque_[k] / dot(w, w);
    for (int c = 0; c < dimension; ++c) couples_.gradient[c * couples_.count + k] = factor * z_w[c];
  }
}

// Eqs. (11) and (18): F, its slopes and, along lines, p.
void Elements::evaluate_forces(Family& family, bool along_lines) {
  const int springs = length(family.springs);
  for (int k = 0; k < family.group.count; ++k) {
    const double s = family.s[k], rate = family.rate[k];
    double by_position, position_slope, by_rate, rate_slope;
    if (k < springs) {
      const Spring& spring = family.springs[k];
      const double off =
          along_lines ? s - spring.free : std::remainder(s - spring.free, 2 * std::numbers::pi);
      by_position = spring.stiffness * off;
      position_slope = spring.stiffness;
      by_rate = spring.damping * rate;
      rate_slope = spring.damping;
    } else {
      const Law& law = *family.laws[k - springs];
      const double factor = family.law_factor[k - springs];
      const Curve::Sample position = law.by_position.at(s), damping = law.by_rate.at(rate);
      by_position = factor * position.value;
      position_slope = factor * position.slope;
      by_rate = factor * damping.value;
      rate_slope = factor * damping.slope;
    }
    family.force[k] = by_position + by_rate;
    family.slope[k] = dt_2_ * rate_slope + dt2_4_ * position_slope;
    if (along_lines) {
      geometric_[k] = dt2_4_ * std::max(0.0, s > 0.0 ? by_position / s : position_slope);
      family.slope[k] -= geometric_[k];  // of p (I - e e^T)
    }
  }
}

}  // namespace mbs::csc_ldl
