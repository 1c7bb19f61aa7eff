// Schedules at set-up; in the step, products of short arrays and gathered sums.
#include "assembly.hpp"

#include <cstddef>
#include <utility>

#include "schedule.hpp"

namespace mbs::csc_cholmod {
namespace {

std::vector<double> constant_force(const Model& model, double factor,
                                   const std::vector<int>& number) {
  std::vector<double> result(model.variables());
  for (int i = 0; i < model.variables(); ++i) result[number[i]] = factor * model.force()[i];
  return result;
}

}  // namespace

Assembly::Assembly(const Model& model, const StepSettings& settings, const HalfPattern& pattern,
                   std::vector<int> number, Half half)
    : quarter_(settings.step * settings.step / 4.0),
      penalty_(settings.penalty),
      coordinates_(model, std::move(number)),
      lowered_(model, coordinates_),
      lowered_forces_(model, coordinates_),
      pattern_(pattern.renumbered(half, coordinates_.number())),
      rows_schedule_(row_contributions(lowered_)),
      tangent_schedule_(tangent_contributions(lowered_, lowered_forces_, pattern_)),
      mass_(model, pattern_.half(), coordinates_.number()),
      constraints_(lowered_),
      forces_(lowered_forces_, settings),
      force_(constant_force(model, quarter_, coordinates_.number())),
      drivers_(model, settings, coordinates_, lowered_, force_),
      constant_(mass_values(model, pattern_, coordinates_.number())),
      products_(2 * (lowered_.products() + lowered_forces_.products())),
      row_(lowered_.rows()) {
  add_linear_products(lowered_.linear, pattern_, quarter_ * penalty_, constant_);
  tangent_ = constant_;
}

void Assembly::drive(double t, double* q, double* u) {
  drivers_.drive(t, q, u, constraints_.target(), force_.data());
}

void Assembly::update_multipliers(double* lambda) const {
  const double* phi = constraints_.phi();
  for (std::size_t k = 0; k < row_.size(); ++k) lambda[k] += penalty_ * phi[k];  // Eq. (1)
}

void Assembly::residual(const double* q, const double* u, const double* s, const double* lambda,
                        double* result) {
  const double* phi = constraints_.phi();
  for (std::size_t k = 0; k < row_.size(); ++k) {
    row_[k] = -quarter_ * (lambda[k] + penalty_ * phi[k]);
  }
  mass_.subtract_product(force_.data(), s, result);
  constraints_.multiply(row_.data());
  rows_schedule_.sum(result, constraints_.forces(), result);  // Eq. (3)
  if (!forces_.empty()) {
    forces_.evaluate(q, u);
    forces_.add_loads(q, result);
  }
}

void Assembly::refresh_tangent() {
  constraints_.multiply_pairs(quarter_ * penalty_, products_.data());
  if (!forces_.empty()) forces_.tangent(products_.data() + 2 * lowered_.products());
  tangent_schedule_.sum(constant_.data(), products_.data(), tangent_.data());  // Eq. (5)
}

void Assembly::project_velocity(const double* q, const double* u, double* velocity) {
  mass_.product(u, velocity);  // Eq. (6)
  if (!forces_.empty()) forces_.add_product(u, velocity);
  subtract_rates(q, velocity);
}

void Assembly::project_both(const double* q, const double* u, const double* s, double* velocity,
                            double* acceleration) {
  mass_.products(u, s, velocity, acceleration);  // Eq. (6)
  if (!forces_.empty()) {
    forces_.add_product(u, velocity);
    forces_.add_product(s, acceleration);
  }
  subtract_rates(q, velocity);
}

void Assembly::subtract_rates(const double* q, double* velocity) {
  for (const DrivenRow& row : drivers_.rows()) {
    const double factor = -quarter_ * penalty_ * drivers_.rate(row, q);  // Eq. (6)
    constraints_.add_row(row.row, factor, velocity);
  }
}

void Assembly::subtract_velocity_terms(const double* q, const double* u, double* acceleration) {
  // (dt^2/4)^2 v v = (dt^2/4) u u.
  constraints_.velocity_terms(u, -quarter_ * penalty_, row_.data());
  for (const DrivenRow& row : drivers_.rows()) {
    row_[row.row] -= quarter_ * penalty_ * drivers_.acceleration(row, q);
  }
  constraints_.multiply(row_.data());
  rows_schedule_.sum(acceleration, constraints_.forces(), acceleration);  // Eq. (6)
}

}  // namespace mbs::csc_cholmod
