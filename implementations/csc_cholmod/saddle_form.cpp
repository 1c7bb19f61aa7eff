// Schedules at set-up; in the step, one gathered sum writes the matrix.
#include "saddle_form.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "saddle_schedule.hpp"
#include "schedule.hpp"

namespace mbs::csc_cholmod {

namespace {

/// Unknown i of the model is the result[i]-th unknown in the order of elimination.
std::vector<int> ranks(const std::vector<int>& place, int unknowns) {
  std::vector<int> order(unknowns), result(unknowns);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int i) { return place[i]; });
  for (int k = 0; k < unknowns; ++k) result[order[k]] = k;
  return result;
}

/// Places of the unknowns in the order of elimination, then of the rows.
std::vector<int> by_rank(std::vector<int> place, int unknowns) {
  std::sort(place.begin(), place.begin() + unknowns);
  return place;
}

}  // namespace

SaddleForm::SaddleForm(const Model& model, const StepSettings& settings, Method method)
    : SaddleForm(model, settings, method, saddle_places(model, method)) {}

SaddleForm::SaddleForm(const Model& model, const StepSettings& settings, Method method,
                       std::vector<int> place)
    : Assembly(model, settings, ranks(place, model.variables()),
               preferred_half(method.factorization)),
      place_(by_rank(std::move(place), model.variables())),
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
