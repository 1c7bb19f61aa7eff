// Springs and dampers between two points: their forces, and their share of C and K.
#include "springs.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics.hpp"

namespace mbs::armadillo_dense {

Springs::Springs(const Model& model, const Layout& layout, const StepSettings& settings)
    : h_(settings.step * settings.step / 4.0) {
  for (const Spring& spring : model.springs()) {
    Element element{.a = layout.starts[spring.a],
                    .b = layout.starts[spring.b],
                    .count = 0,
                    .ends = {layout.starts[spring.a], layout.starts[spring.b]},
                    .sign = {},
                    .stiffness = spring.stiffness,
                    .damping = spring.damping,
                    .length = spring.length,
                    .weight = settings.step / 2.0 * spring.damping + h_ * spring.stiffness,
                    .e = {},
                    .axial = 0.0,
                    .transverse = 0.0};
    element.count = layout.distinct_free(element.ends);
    for (int i = 0; i < 2; ++i) element.sign[i] = element.ends[i] == element.a ? 1.0 : -1.0;
    if (element.count > 0) springs_.push_back(element);
  }
}

template <int dimension>
void Springs::evaluate(const double* x, const double* v, double* rhs) {
  for (Element& spring : springs_) {  // Eq. (11)
    const auto d = difference<dimension>(x, spring.a, spring.b);
    const auto rate = difference<dimension>(v, spring.a, spring.b);
    const double length = std::sqrt(dot<dimension>(d, d));
    const double inverse = length > 0.0 ? 1.0 / length : 0.0;
    double length_rate = 0.0;
    for (int k = 0; k < dimension; ++k) {
      spring.e[k] = d[k] * inverse;
      length_rate += spring.e[k] * rate[k];
    }
    spring.transverse = h_ * std::max(0.0, spring.stiffness * (1.0 - spring.length * inverse));
    spring.axial = spring.weight - spring.transverse;
    const double scaled =
        h_ * (spring.stiffness * (length - spring.length) + spring.damping * length_rate);
    for (int i = 0; i < spring.count; ++i) {
      for (int k = 0; k < dimension; ++k) {
        rhs[spring.ends[i] + k] -= spring.sign[i] * scaled * spring.e[k];
      }
    }
  }
}

template <int dimension>
void Springs::add_to(double* T, arma::uword height) const {
  for (const Element& spring : springs_) {  // Eqs. (5), (11)
    for (int j = 0; j < spring.count; ++j) {
      for (int i = j; i < spring.count; ++i) {
        double* const block = T + arma::uword(spring.ends[j]) * height + spring.ends[i];
        const double sign = spring.sign[i] * spring.sign[j];
        for (int column = 0; column < dimension; ++column) {
          const double along = sign * spring.axial * spring.e[column];
          for (int row = 0; row < dimension; ++row) {
            block[arma::uword(column) * height + row] += along * spring.e[row];
          }
          block[arma::uword(column) * height + column] += sign * spring.transverse;
        }
      }
    }
  }
}

template void Springs::evaluate<2>(const double*, const double*, double*);
template void Springs::evaluate<3>(const double*, const double*, double*);
template void Springs::add_to<2>(double*, arma::uword) const;
template void Springs::add_to<3>(double*, arma::uword) const;

}  // namespace mbs::armadillo_dense
