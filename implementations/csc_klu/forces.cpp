// Forces of springs, torsion springs and couples, Eq. (11), and products with their C and K.
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
      across_(stiff_ends_.size(), 0.0) {}

template <int dim>
void Forces<dim>::evaluate(const double* q, const double* v, double* right) {
  evaluate_springs(q, v, right);
  evaluate_torsions(q, v, right);
  evaluate_couples(q, right);
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
void Forces<dim>::evaluate_springs(const double* q, const double* v, double* right) {
  int end = 0;
  double* along = along_.data();
  double* across = across_.data();
  for (const auto& spring : pattern_.springs) {
    Vector<dim> e = difference<dim>(q, spring.a, spring.b);
    const double length = std::sqrt(dot(e, e));
    const double inverse = length > 0.0 ? 1.0 / length : 0.0;
    for (int k = 0; k < dim; ++k) e[k] *= inverse;
    const double rate = dot(e, difference<dim>(v, spring.a, spring.b));
    const double force = spring.stiffness * (length - spring.length) + spring.damping * rate;
    const double p = std::max(0.0, spring.stiffness * (1.0 - spring.length * inverse));
    *across = weight_ * p;                                                               // Eq. (11)
    *along++ = damping_weight_ * spring.damping + weight_ * spring.stiffness - *across;  // Eq. (11)
    ++across;
    end = apply(end, spring.ends_end, e, e, force, right);  // second = 0 at all ends
  }
}

template <int dim>
void Forces<dim>::evaluate_torsions(const double* q, const double* v, double* right) {
  int end = pattern_.springs.empty() ? 0 : pattern_.springs.back().ends_end;
  double* along = along_.data() + pattern_.springs.size();
  for (const auto& torsion : pattern_.torsions) {
    const Vector<dim> u = difference<dim>(q, torsion.a, torsion.b);
    const Vector<dim> w = difference<dim>(q, torsion.c, torsion.d);
    const double* const z = q + torsion.axis;
    const double angle = std::atan2(dot(cross(z, u, 1.0), w), dot(u, w));  // z.(u x w) = (z x u).w
    const Vector<dim> by_u = cross(z, u, -1.0 / dot(u, u));
    const Vector<dim> by_w = cross(z, w, 1.0 / dot(w, w));
    const double rate = dot(by_u, difference<dim>(v, torsion.a, torsion.b)) +
                        dot(by_w, difference<dim>(v, torsion.c, torsion.d));
    const double turned = std::remainder(angle - torsion.angle, 2.0 * std::numbers::pi);
    const double torque = torsion.stiffness * turned + torsion.damping * rate;
    *along++ = damping_weight_ * torsion.damping + weight_ * torsion.stiffness;  // Eq. (11)
    end = apply(end, torsion.ends_end, by_u, by_w, torque, right);
  }
}

template <int dim>
void Forces<dim>::evaluate_couples(const double* q, double* right) {
  int end = stiff_ends_.empty() ? 0 : stiff_ends_.back();
  for (const auto& couple : pattern_.couples) {
    const Vector<dim> w = difference<dim>(q, couple.a, couple.b);
    const Vector<dim> by_w = cross(q + couple.axis, w, 1.0 / dot(w, w));
    end = apply(end, couple.ends_end, by_w, by_w, -couple.torque, right);  // second = 0
  }
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
    for (int k = 0; k < dim; ++k) relative[k] *= across_[element];  // zero for torsion springs
    for (int end = begin; end < ends_end; ++end) {
      const MovedPoint& moved = pattern_.ends[end];
      for (int k = 0; k < dim; ++k) {
        y[moved.coordinate + k] += rate * gradient(end)[k] + moved.first * relative[k];  // Eq. (6)
      }
    }
    begin = ends_end;
  }
}

template class Forces<2>;
template class Forces<3>;

}  // namespace mbs::csc_klu
