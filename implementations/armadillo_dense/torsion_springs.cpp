// Springs and dampers on an angle between two directions: their forces, and their share of C and K.
#include "torsion_springs.hpp"

#include <cmath>
#include <numbers>

#include "kinematics.hpp"

namespace mbs::armadillo_dense {

TorsionSprings::TorsionSprings(const Model& model, const Layout& layout,
                               const StepSettings& settings)
    : half_step_(settings.step / 2.0), h_(settings.step * settings.step / 4.0) {
  for (const TorsionSpring& spring : model.torsion_springs()) {
    const Element element = lower(spring, layout);
    if (element.count > 0) springs_.push_back(element);
  }
}

TorsionSprings::Element TorsionSprings::lower(const TorsionSpring& spring,
                                              const Layout& layout) const {
  const std::vector<int>& starts = layout.starts;
  Element element{.a = starts[spring.a],
                  .b = starts[spring.b],
                  .c = starts[spring.c],
                  .d = starts[spring.d],
                  .axis = layout.dimension == 3 ? starts[spring.axis] : 0,
                  .count = 0,
                  .ends = {},
                  .stiffness = spring.stiffness,
                  .damping = spring.damping,
                  .angle = spring.angle,
                  .weight = half_step_ * spring.damping + h_ * spring.stiffness};
  std::array<int, 4> at = {element.a, element.b, element.c, element.d};
  element.count = layout.distinct_free(at);
  for (int i = 0; i < element.count; ++i) {
    element.ends[i] = {.start = at[i],
                       .w_cd = double(at[i] == element.c) - double(at[i] == element.d),
                       .w_ab = double(at[i] == element.a) - double(at[i] == element.b),
                       .g = {}};
  }
  return element;
}

template <int dimension>
void TorsionSprings::evaluate(const double* x, const double* v, double* rhs) {
  for (Element& spring : springs_) {  // Eq. (11)
    const auto u = difference<dimension>(x, spring.a, spring.b);
    const auto w = difference<dimension>(x, spring.c, spring.d);
    auto g_u = turned<dimension>(x, spring.axis, u);
    auto g_w = turned<dimension>(x, spring.axis, w);
    const double angle = std::atan2(dot<dimension>(g_u, w), dot<dimension>(u, w));
    const double square_u = dot<dimension>(u, u);
    const double square_w = dot<dimension>(w, w);
    for (int k = 0; k < dimension; ++k) {
      g_u[k] /= -square_u;
      g_w[k] /= square_w;
    }
    const double rate = dot<dimension>(g_u, difference<dimension>(v, spring.a, spring.b)) +
                        dot<dimension>(g_w, difference<dimension>(v, spring.c, spring.d));
    const double turn = std::remainder(angle - spring.angle, 2.0 * std::numbers::pi);
    const double scaled = h_ * (spring.stiffness * turn + spring.damping * rate);
    for (int i = 0; i < spring.count; ++i) {
      End& end = spring.ends[i];
      for (int k = 0; k < dimension; ++k) {
        end.g[k] = end.w_cd * g_w[k] + end.w_ab * g_u[k];
        rhs[end.start + k] -= scaled * end.g[k];
      }
    }
  }
}

template <int dimension>
void TorsionSprings::add_to(double* T, arma::uword height) const {
  for (const Element& spring :
       springs_) {  // Eqs. (5), (11); ends ascend, so these are lower blocks
    for (int j = 0; j < spring.count; ++j) {
      const End& right = spring.ends[j];
      for (int column = 0; column < dimension; ++column) {
        double* const target = T + arma::uword(right.start + column) * height;
        const double factor = spring.weight * right.g[column];
        for (int i = j; i < spring.count; ++i) {
          const End& left = spring.ends[i];
          for (int row = 0; row < dimension; ++row)
            target[left.start + row] += factor * left.g[row];
        }
      }
    }
  }
}

template void TorsionSprings::evaluate<2>(const double*, const double*, double*);
template void TorsionSprings::evaluate<3>(const double*, const double*, double*);
template void TorsionSprings::add_to<2>(double*, arma::uword) const;
template void TorsionSprings::add_to<3>(double*, arma::uword) const;

}  // namespace mbs::armadillo_dense
