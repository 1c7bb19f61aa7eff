// What the schemes have in common: M and the residual, over the constraints and forces.
#include "assembly.hpp"

#include <algorithm>
#include <string>

#include "blas.hpp"

namespace mbs::armadillo_dense {

namespace {

constexpr double kLargestMatrix = 2.0 * 1024.0 * 1024.0 * 1024.0;  // bytes

}  // namespace

void require_storable(const Model& model, Scheme scheme) {
  const double n = model.variables();
  const double m = model.constraints();
  const double moving = n + model.dimension() * double(model.driven_points().size());
  const double matrix = scheme == Scheme::saddle_point ? (n + m) * (n + m) : n * n;
  const double entries = std::max(matrix, moving * m);
  if (8.0 * entries > kLargestMatrix) {
    throw Unsupported("a dense matrix for " + std::to_string(model.variables()) +
                      " variables and " + std::to_string(model.constraints()) +
                      " constraints would take more than 2 GiB");
  }
}

Assembly::Assembly(const Model& model, const StepSettings& settings)
    : layout_(model),
      n_(model.variables()),
      m_(model.constraints()),
      h_(settings.step * settings.step / 4.0),
      constraints_(model, layout_),
      drivers_(model, layout_),
      forces_(model, layout_, settings),
      M_(n_, n_, arma::fill::zeros),
      scaled_Q_(n_) {
  for (const MassEntry& entry : model.mass()) M_(entry.row, entry.col) = entry.value;
  std::ranges::transform(model.force(), scaled_Q_.begin(), [this](double Q) { return h_ * Q; });
}

void Assembly::drive(double t, arma::vec& x, arma::vec& v, arma::vec& a) {
  drivers_.sample(t, x, v, a, constraints_.values());
  drivers_.load(h_, a, scaled_Q_);
}

void Assembly::negative_residual(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                                 const arma::vec& mu, arma::vec& rhs) {
  rhs = scaled_Q_;  // Eq. (3) with M a' in place of (4/Δt²) M q' + M â
  if (!forces_.empty()) forces_.evaluate(x, v, rhs);
  add_symmetric_product(-h_, M_, a.memptr(), rhs.memptr());
  add_product(-h_, constraints_.jacobian(), layout_.moving, n_, m_, mu.memptr(), rhs.memptr());
}

void Assembly::rates(const arma::vec& v, arma::vec& out) const {
  constraints_.multiply(v, out);  // Φq v + Φt, as v has the velocities of driven points
  drivers_.subtract_rates(out);
}

void Assembly::accelerations(const arma::vec& v, const arma::vec& a, arma::vec& out) const {
  constraints_.multiply(a, out);  // Φq a + Φ̇q v + Φ̇t, likewise
  constraints_.add_accelerations(v, out);
  drivers_.subtract_accelerations(out);
}

}  // namespace mbs::armadillo_dense
