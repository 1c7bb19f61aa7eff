// Forces that depend on the motion: springs, torsion springs and couples.
#include "forces.hpp"

#include <utility>

#include "kinematics.hpp"

namespace mbs::armadillo_dense {

Forces::Forces(const Model& model, const Layout& layout, const StepSettings& settings)
    : layout_(layout),
      springs_(model, layout, settings),
      torsion_springs_(model, layout, settings) {
  const double h = settings.step * settings.step / 4.0;
  for (const Couple& couple : model.couples()) {
    const int a = layout.starts[couple.a];
    const int b = layout.starts[couple.b];
    const int axis = layout.dimension == 3 ? layout.starts[couple.axis] : 0;
    // Seen from b, w and the force change sign: both ends are of one form.
    for (const auto& [end, other] : {std::pair(a, b), std::pair(b, a)}) {
      if (!layout.is_free(end)) continue;
      couples_.push_back({.end = end, .other = other, .axis = axis, .torque = h * couple.torque});
    }
  }
}

template <int dimension>
void Forces::evaluate_couples(const double* x, double* rhs) const {
  for (const CoupleEnd& couple : couples_) {
    const auto w = difference<dimension>(x, couple.end, couple.other);
    const auto direction = turned<dimension>(x, couple.axis, w);
    const double factor = couple.torque / dot<dimension>(w, w);
    for (int k = 0; k < dimension; ++k) rhs[couple.end + k] += factor * direction[k];
  }
}

void Forces::evaluate(const arma::vec& x, const arma::vec& v, arma::vec& rhs) {
  if (layout_.dimension == 2) {
    springs_.evaluate<2>(x.memptr(), v.memptr(), rhs.memptr());
    torsion_springs_.evaluate<2>(x.memptr(), v.memptr(), rhs.memptr());
    evaluate_couples<2>(x.memptr(), rhs.memptr());
  } else {
    springs_.evaluate<3>(x.memptr(), v.memptr(), rhs.memptr());
    torsion_springs_.evaluate<3>(x.memptr(), v.memptr(), rhs.memptr());
    evaluate_couples<3>(x.memptr(), rhs.memptr());
  }
}

void Forces::add_to(double* T, arma::uword height) const {
  if (layout_.dimension == 2) {
    springs_.add_to<2>(T, height);
    torsion_springs_.add_to<2>(T, height);
  } else {
    springs_.add_to<3>(T, height);
    torsion_springs_.add_to<3>(T, height);
  }
}

}  // namespace mbs::armadillo_dense
