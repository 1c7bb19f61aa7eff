// Schedules at set-up; in the step, one gathered sum writes the matrix.
#include "saddle_form.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "saddle_schedule.hpp"
#include "schedule.hpp"

namespace mbs::csc_cholmod {

SaddleForm::SaddleForm(const Model& model, const StepSettings& settings, Method method)
    : SaddleForm(model, settings, method, fill_reducing_order(tangent_pattern(model), method)) {}

SaddleForm::SaddleForm(const Model& model, const StepSettings& settings, Method method,
                       std::vector<int> number)
    : Assembly(model, settings, std::move(number), preferred_half(method.factorization)),
      place_(saddle_places(model, coordinates_, lowered_)),
      pattern_(saddle_pattern(model, coordinates_, lowered_, lowered_forces_, place_,
                              preferred_half(method.factorization))),
      schedule_(saddle_contributions(lowered_, lowered_forces_, place_, pattern_)),
      constant_(saddle_constants(model, settings, coordinates_, lowered_, place_, pattern_)),
      matrix_(constant_),
      summands_(2 * (lowered_.values() + lowered_forces_.products())),
      solution_(place_.size()),
      solver_(method, pattern_, matrix_.data(),
              {place_.begin() + coordinates_.unknowns(), place_.end()}) {}

void SaddleForm::residual(const double* q, const double* u, const double* s, const double* lambda,
                          double* right) {
  for (std::size_t k = 0; k < row_.size(); ++k) row_[k] = -quarter_ * lambda[k];
  balance(q, u, s, right);  // Eq. (12)
  const double* phi = constraints_.phi();
  double* __restrict rows = right + coordinates_.unknowns();
  for (std::size_t k = 0; k < row_.size(); ++k) rows[k] = -phi[k];  // Eq. (12)
}

void SaddleForm::refresh_matrix() {
  const int count = lowered_.values();
  const double* __restrict values = constraints_.values();
  double* __restrict plus = summands_.data();
  double* __restrict minus = plus + count;
  for (int i = 0; i < count; ++i) {
    plus[i] = values[i];
    minus[i] = -values[i];
  }
  if (!forces_.empty()) forces_.tangent(minus + count);
  schedule_.sum(constant_.data(), summands_.data(), matrix_.data());  // Eq. (12)
}

void SaddleForm::solve(const double* right, double* x) {
  for (std::size_t i = 0; i < place_.size(); ++i) solution_[place_[i]] = right[i];
  solver_.solve(solution_.data(), solution_.data());
  for (int i = 0; i < coordinates_.unknowns(); ++i) x[i] = solution_[place_[i]];
}

void SaddleForm::update_multipliers(double* lambda) const {
  const int* place = place_.data() + coordinates_.unknowns();
  for (std::size_t k = 0; k < row_.size(); ++k) {
    lambda[k] += solution_[place[k]] / quarter_;  // Eq. (12)
  }
}

void SaddleForm::projection(double* right) const {
  double* __restrict rows = std::fill_n(right, coordinates_.unknowns(), 0.0);
  for (std::size_t k = 0; k < row_.size(); ++k) rows[k] = -row_[k];  // Eq. (13)
}

}  // namespace mbs::csc_cholmod
