// Forces of springs, laws and couples, Eqs. (11) and (18), and products with their C and K.
#include "forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mbs::csc_klu {

template <int dim>
Forces<dim>::Forces(const ForcePattern& pattern, double step)
    : pattern_(pattern),
      stiff_ends_(pattern.stiff_ends()),
      damping_weight_(step / 2.0),
      weight_(step * step / 4.0),
      gradient_(dim * pattern.ends.size(), 0.0),
      along_(stiff_ends_.size(), 0.0),
      across_(stiff_ends_.size(), 0.0),
      factors_(pattern.line_laws.size() + pattern.axis_laws.size()) {
  set_time(0.0);
}

template <int dim>
void Forces<dim>::set_time(double t) {
  double* factor = factors_.data();
  for (const auto& law : pattern_.line_laws) *factor++ = law.law->factor.at(t).value;
  for (const auto& law : pattern_.axis_laws) *factor++ = law.law->factor.at(t).value;
}

template <int dim>
auto Forces<dim>::respond(const Law& law, double factor, double s, double rate, double inverse)
    -> Response {
  const Curve::Sample held = law.by_position.at(s), free = law.by_rate.at(rate);
  const double secant = inverse > 0.0 ? held.value * inverse : held.slope;
  return {factor * (held.value + free.value), factor * held.slope, factor * free.slope,
          std::max(0.0, factor * secant)};  // Eq. (18)
}

template <int dim>
void Forces<dim>::evaluate(const double* q, const double* v, double* right) {
  Place place;
  const double* factor = factors_.data();
  for (const auto& spring : pattern_.springs) {
    const auto linear = [&spring](double length, double rate, double inverse) -> Response {
      return {spring.stiffness * (length - spring.length) + spring.damping * rate, spring.stiffness,
              spring.damping, std::max(0.0, spring.stiffness * (1.0 - spring.length * inverse))};
    };
    evaluate_line(spring, q, v, linear, place, right);
  }
  for (const auto& law : pattern_.line_laws) {
    const auto tabulated = [&law, &factor](double length, double rate, double inverse) {
      return respond(*law.law, *factor, length, rate, inverse);
    };
    evaluate_line(law, q, v, tabulated, place, right);
    ++factor;
  }
  for (const auto& torsion : pattern_.torsions) {
    const auto linear = [&torsion](double angle, double rate) -> Response {
      const double turned = std::remainder(angle - torsion.angle, 2.0 * std::numbers::pi);
      return {torsion.stiffness * turned + torsion.damping * rate, torsion.stiffness,
              torsion.damping, 0.0};
    };
    evaluate_corner(torsion, q, v, linear, place, right);
  }
  for (const auto& law : pattern_.axis_laws) {
    const auto tabulated = [&law, &factor](double angle, double rate) {
      return respond(*law.law, *factor, angle, rate, 0.0);
    };
    evaluate_corner(law, q, v, tabulated, place, right);
    ++factor;
  }
  for (const auto& couple : pattern_.couples) {
    const Vector<dim> w = difference<dim>(q, couple.a, couple.b);
    const Vector<dim> by_w = cross(q + couple.axis, w, 1.0 / dot(w, w));
    place.end = apply(place.end, couple.ends_end, by_w, by_w, -couple.torque, right);  // second = 0
  }
}

template <int dim>
int Forces<dim>::apply(int end, int ends_end, const Vector<dim>& by_u, const Vector<dim>& by_w,
                       double force, double* right) {
  for (; end < ends_end; ++end) {
    const MovedPoint& moved = pattern_.ends[end];
    double* const g = gradient_.data() + dim * end;
    double* const at = right + moved.coordinate;
    for (int k = 0; k < dim; ++k) g[k] = moved.first * by_u[k] + moved.second * by_w[k];
    for (int k = 0; k < dim; ++k) at[k] -= weight_ * force * g[k];  // Eq. (11)
  }
  return ends_end;
}

template <int dim>
template <class Line, class Respond>
void Forces<dim>::evaluate_line(const Line& line, const double* q, const double* v, Respond respond,
                                Place& place, double* right) {
  Vector<dim> e = difference<dim>(q, line.a, line.b);
  const double length = std::sqrt(dot(e, e));
  const double inverse = length > 0.0 ? 1.0 / length : 0.0;
  for (int k = 0; k < dim; ++k) e[k] *= inverse;
  const double rate = dot(e, difference<dim>(v, line.a, line.b));
  const Response response = respond(length, rate, inverse);
  const double across = weight_ * response.p;  // Eq. (11)
  across_[place.element] = across;
  along_[place.element] =
      damping_weight_ * response.damping + weight_ * response.stiffness - across;  // Eq. (11)
  place.end = apply(place.end, line.ends_end, e, e, response.force, right);        // second = 0
  ++place.element;
}

template <int dim>
template <class Corner, class Respond>
void Forces<dim>::evaluate_corner(const Corner& corner, const double* q, const double* v,
                                  Respond respond, Place& place, double* right) {
  const Vector<dim> u = difference<dim>(q, corner.a, corner.b);
  const Vector<dim> w = difference<dim>(q, corner.c, corner.d);
  const double* const z = q + corner.axis;
  const double angle = std::atan2(dot(cross(z, u, 1.0), w), dot(u, w));  // z.(u x w) = (z x u).w
  const Vector<dim> by_u = cross(z, u, -1.0 / dot(u, u));
  const Vector<dim> by_w = cross(z, w, 1.0 / dot(w, w));
  const double rate = dot(by_u, difference<dim>(v, corner.a, corner.b)) +
                      dot(by_w, difference<dim>(v, corner.c, corner.d));
  const Response response = respond(angle, rate);
  along_[place.element] =
      damping_weight_ * response.damping + weight_ * response.stiffness;  // Eq. (11)
  place.end = apply(place.end, corner.ends_end, by_u, by_w, response.force, right);
  ++place.element;
}

template <int dim>
void Forces<dim>::copy_stiffness(const Forces& other) {
  std::ranges::copy(other.gradient_, gradient_.begin());
  std::ranges::copy(other.along_, along_.begin());
  std::ranges::copy(other.across_, across_.begin());
}

template <int dim>
void Forces<dim>::add_product(const double* x, double* y) const {
  int begin = 0;
  for (std::size_t element = 0; element < stiff_ends_.size(); ++element) {
    const int ends_end = stiff_ends_[element];
    double rate = 0.0;       // g . x
    Vector<dim> relative{};  // S^T x
    for (int end = begin; end < ends_end; ++end) {
      const MovedPoint& moved = pattern_.ends[end];
      for (int k = 0; k < dim; ++k) rate += gradient(end)[k] * x[moved.coordinate + k];
      for (int k = 0; k < dim; ++k) relative[k] += moved.first * x[moved.coordinate + k];
    }
    rate *= along_[element];
    for (int k = 0; k < dim; ++k) relative[k] *= across_[element];  // zero about an axis
    for (int end = begin; end < ends_end; ++end) {
      const MovedPoint& moved = pattern_.ends[end];
      for (int k = 0; k < dim; ++k) {
        y[moved.coordinate + k] += rate * gradient(end)[k] + moved.first * relative[k];  // Eq. (15)
      }
    }
    begin = ends_end;
  }
}

template class Forces<2>;
template class Forces<3>;

}  // namespace mbs::csc_klu
