// Products of short arrays and gathered sums.
#include "assembly.hpp"

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

Assembly::Assembly(const Model& model, const StepSettings& settings, std::vector<int> number,
                   Half half)
    : quarter_(settings.step * settings.step / 4.0),
      coordinates_(model, std::move(number)),
      lowered_(model, coordinates_),
      lowered_forces_(model, coordinates_),
      rows_schedule_(row_contributions(lowered_)),
      mass_(model, half, coordinates_.number()),
      constraints_(lowered_),
      forces_(lowered_forces_, settings),
      force_(constant_force(model, quarter_, coordinates_.number())),
      drivers_(model, settings, coordinates_, lowered_, force_),
      row_(lowered_.rows()) {}

void Assembly::drive(double t, double* q, double* u, double* s) {
  drivers_.drive(t, q, u, s, constraints_.target(), force_.data());
  forces_.drive(t);
}

void Assembly::take_first_rate(const double* u) {
  constraints_.first_rate(u, row_.data());
  for (const DrivenTarget& d : drivers_.targets()) row_[d.row] -= d.rate;
}

void Assembly::take_second_rate(const double* u, const double* s) {
  constraints_.second_rate(u, s, row_.data());  // (dt^2/4) v v = u u
  for (const DrivenTarget& d : drivers_.targets()) row_[d.row] -= d.acceleration;
}

void Assembly::balance(const double* q, const double* u, const double* s, double* result) {
  constraints_.evaluate_jacobian();
  mass_.subtract_product(force_.data(), s, result);
  add_row_forces(result);
  if (!forces_.empty()) {
    forces_.evaluate(q, u);
    forces_.add_loads(q, result);
  }
}

void Assembly::add_row_forces(double* result) {
  constraints_.multiply(row_.data());
  rows_schedule_.sum(result, constraints_.forces(), result);
}

}  // namespace mbs::csc_cholmod
