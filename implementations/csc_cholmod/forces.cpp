// Elements write summands, schedules gather them.
#include "forces.hpp"

#include <cstddef>

#include "schedule.hpp"

namespace mbs::csc_cholmod {
namespace {

std::vector<Contribution> contributions(const LoweredForces& lowered) {
  std::vector<Contribution> result;
  add_row_contributions(lowered.gradients(), lowered.values(), result);
  add_row_contributions(lowered.couple_rows(), lowered.values(), result);
  return result;
}

std::vector<ScaledLaw> scaled(const std::vector<const Law*>& laws, const StepSettings& settings) {
  std::vector<ScaledLaw> result;
  for (const Law* law : laws) result.emplace_back(*law, settings);
  return result;
}

std::vector<int> driven(const std::vector<ScaledLaw>& laws) {
  std::vector<int> result;
  for (std::size_t k = 0; k < laws.size(); ++k) {
    if (laws[k].is_driven()) result.push_back(static_cast<int>(k));
  }
  return result;
}

void negate(const double* __restrict values, int count, double* __restrict result) {
  for (int i = 0; i < count; ++i) result[i] = -values[i];
}

}  // namespace

Forces::Forces(const LoweredForces& lowered, const StepSettings& settings)
    : lowered_(lowered),
      laws_(scaled(lowered.laws, settings)),
      driven_laws_(driven(laws_)),
      springs_(lowered.springs, laws_, settings),
      torsions_(lowered.springs.dimension, lowered.torsions, laws_, settings),
      couples_(lowered.springs.dimension, lowered.couples, settings),
      load_rows_(contributions(lowered)),
      summands_(2 * lowered.values()) {}

void Forces::evaluate(const double* q, const double* u) {
  springs_.evaluate(q, u);
  torsions_.evaluate(q, u);
}

void Forces::add_loads(const double* q, double* result) {
  couples_.loads(q, torsions_.loads(springs_.loads(summands_.data())));
  negate(summands_.data(), lowered_.values(), summands_.data() + lowered_.values());
  load_rows_.sum(result, summands_.data(), result);
}

void Forces::tangent(double* products) const {
  torsions_.tangent(springs_.tangent(products));
  negate(products, lowered_.products(), products + lowered_.products());
}

}  // namespace mbs::csc_cholmod
