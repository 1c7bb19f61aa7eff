// Schedules at set-up; in the step, one gathered sum writes T.
#include "penalty_form.hpp"

#include <algorithm>
#include <cstddef>

#include "schedule.hpp"

namespace mbs::csc_cholmod {
namespace {

std::vector<double> constants(const Model& model, const std::vector<int>& number,
                              const LinearBlock& linear, const HalfPattern& pattern,
                              double factor) {
  std::vector<double> result = mass_values(model, pattern, number);
  add_linear_products(linear, pattern, factor, result);
  return result;
}

}  // namespace

PenaltyForm::PenaltyForm(const Model& model, const StepSettings& settings, Method method)
    : PenaltyForm(model, settings, tangent_pattern(model), method) {}

PenaltyForm::PenaltyForm(const Model& model, const StepSettings& settings,
                         const HalfPattern& pattern, Method method)
    : Assembly(model, settings, fill_reducing_order(pattern, method),
               preferred_half(method.factorization)),
      penalty_(settings.penalty),
      pattern_(pattern.renumbered(preferred_half(method.factorization), coordinates_.number())),
      schedule_(tangent_contributions(lowered_, lowered_forces_, pattern_)),
      constant_(
          constants(model, coordinates_.number(), lowered_.linear, pattern_, quarter_ * penalty_)),
      tangent_(constant_),
      products_(2 * (lowered_.products() + lowered_forces_.products())),
      solver_(method, pattern_, tangent_.data()) {}

void PenaltyForm::residual(const double* q, const double* u, const double* s, const double* lambda,
                           double* right) {
  const double* phi = constraints_.phi();
  for (std::size_t k = 0; k < row_.size(); ++k) {
    row_[k] = -quarter_ * (lambda[k] + penalty_ * phi[k]);
  }
  balance(q, u, s, right);  // Eq. (3)
}

void PenaltyForm::refresh_matrix() {
  constraints_.multiply_pairs(quarter_ * penalty_, products_.data());
  if (!forces_.empty()) forces_.tangent(products_.data() + 2 * lowered_.products());
  schedule_.sum(constant_.data(), products_.data(), tangent_.data());  // Eq. (5)
}

void PenaltyForm::update_multipliers(double* lambda) const {
  const double* phi = constraints_.phi();
  for (std::size_t k = 0; k < row_.size(); ++k) lambda[k] += penalty_ * phi[k];  // Eq. (1)
}

void PenaltyForm::projection(double* right) {
  for (double& rate : row_) rate *= -quarter_ * penalty_;
  std::fill_n(right, size(), 0.0);
  add_row_forces(right);  // Eq. (6)
}

}  // namespace mbs::csc_cholmod
