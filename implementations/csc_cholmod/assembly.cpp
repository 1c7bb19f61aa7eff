// Schedules at set-up; in the step, products of short arrays and gathered sums.
#include "assembly.hpp"

#include <cstddef>
#include <utility>

namespace mbs::csc_cholmod {
namespace {

/// Visits each pair of entries of a linear row once: (row, column, product of coefficients).
template <typename Visit>
void for_linear_pairs(const LinearBlock& linear, Visit visit) {
  for (int k = 0; k < linear.count; ++k) {
    for (int s = linear.start[k]; s < linear.start[k + 1]; ++s) {
      for (int t = s; t < linear.start[k + 1]; ++t) {
        visit(linear.column[s], linear.column[t], linear.coefficient[s] * linear.coefficient[t]);
      }
    }
  }
}

/// Visits each pair of entries of each other row once: (row, first entry, second entry).
template <typename Visit>
void for_pairs(const LoweredConstraints& lowered, Visit visit) {
  for (int row = 0; row < lowered.distance.count + lowered.dot.count; ++row) {
    const auto entries = lowered.entries(row);
    for (std::size_t e = 0; e < entries.size(); ++e) {
      for (std::size_t f = e; f < entries.size(); ++f) visit(row, entries[e], entries[f]);
    }
  }
}

std::vector<Contribution> row_contributions(const LoweredConstraints& lowered) {
  std::vector<Contribution> result;
  for (int row = 0; row < lowered.distance.count + lowered.dot.count; ++row) {
    for (const JacobianEntry& e : lowered.entries(row)) {
      result.push_back({e.column, e.value + (e.negative ? lowered.values() : 0)});
    }
  }
  int source = 2 * lowered.values();
  for (int column : lowered.linear.column) result.push_back({column, source++});
  return result;
}

std::vector<Contribution> tangent_contributions(const LoweredConstraints& lowered,
                                                const HalfPattern& pattern) {
  std::vector<Contribution> result;
  for_pairs(lowered, [&](int row, const JacobianEntry& e, const JacobianEntry& f) {
    const int sign = e.negative != f.negative ? lowered.products() : 0;
    result.push_back(
        {pattern.index({e.column, f.column}), lowered.product(row, e.value, f.value) + sign});
  });
  return result;
}

}  // namespace

HalfPattern tangent_pattern(const Model& model) {
  std::vector<int> number(model.variables());
  for (int i = 0; i < model.variables(); ++i) number[i] = i;
  const LoweredConstraints lowered(model, Coordinates(model, number));
  std::vector<Position> positions;
  for (const MassEntry& e : model.mass()) positions.push_back({e.row, e.col});
  for_pairs(lowered, [&](int, const JacobianEntry& e, const JacobianEntry& f) {
    positions.push_back({e.column, f.column});
  });
  for_linear_pairs(lowered.linear, [&](int i, int j, double) { positions.push_back({i, j}); });
  return HalfPattern(Half::lower, model.variables(), positions);
}

std::vector<double> mass_values(const Model& model, const HalfPattern& pattern,
                                const std::vector<int>& number) {
  std::vector<double> values(pattern.nonzeros());
  for (const MassEntry& e : model.mass()) {
    values[pattern.index({number[e.row], number[e.col]})] = e.value;
  }
  return values;
}

void add_linear_products(const LinearBlock& linear, const HalfPattern& pattern, double factor,
                         std::vector<double>& values) {
  for_linear_pairs(linear, [&](int i, int j, double product) {
    values[pattern.index({i, j})] += factor * product;
  });
}

AssemblySchedule::AssemblySchedule(const LoweredConstraints& lowered, const HalfPattern& pattern)
    : rows_(row_contributions(lowered)), tangent_(tangent_contributions(lowered, pattern)) {}

Assembly::Assembly(const Model& model, const StepSettings& settings, const HalfPattern& pattern,
                   std::vector<int> number, Half half)
    : quarter_(settings.step * settings.step / 4.0),
      penalty_(settings.penalty),
      coordinates_(model, std::move(number)),
      lowered_(model, coordinates_),
      pattern_(pattern.renumbered(half, coordinates_.number())),
      schedule_(lowered_, pattern_),
      mass_(model, pattern_.half(), coordinates_.number()),
      constraints_(lowered_),
      force_(model.variables()),
      constant_(mass_values(model, pattern_, coordinates_.number())),
      row_(lowered_.rows()) {
  const std::vector<int>& place = coordinates_.number();
  for (int i = 0; i < model.variables(); ++i) force_[place[i]] = quarter_ * model.force()[i];
  add_linear_products(lowered_.linear, pattern_, quarter_ * penalty_, constant_);
  tangent_ = constant_;
}

void Assembly::update_multipliers(double* lambda) const {
  const double* phi = constraints_.phi();
  for (std::size_t k = 0; k < row_.size(); ++k) lambda[k] += penalty_ * phi[k];
}

void Assembly::residual(const double* s, const double* lambda, double* result) {
  const double* phi = constraints_.phi();
  for (std::size_t k = 0; k < row_.size(); ++k) {
    row_[k] = -quarter_ * (lambda[k] + penalty_ * phi[k]);
  }
  mass_.subtract_product(force_.data(), s, result);
  constraints_.multiply(row_.data());
  schedule_.rows().sum(result, constraints_.forces(), result);  // Eq. (3)
}

void Assembly::refresh_tangent() {
  constraints_.multiply_pairs(quarter_ * penalty_);
  schedule_.tangent().sum(constant_.data(), constraints_.products(), tangent_.data());  // Eq. (5)
}

void Assembly::projections(const double* u, const double* s, double* velocity,
                           double* acceleration) const {
  mass_.products(u, s, velocity, acceleration);  // Eq. (6)
}

void Assembly::subtract_velocity_terms(const double* u, double* acceleration) {
  // (dt^2/4)^2 v v = (dt^2/4) u u.
  constraints_.velocity_terms(u, -quarter_ * penalty_, row_.data());
  constraints_.multiply(row_.data());
  schedule_.rows().sum(acceleration, constraints_.forces(), acceleration);  // Eq. (6)
}

}  // namespace mbs::csc_cholmod
