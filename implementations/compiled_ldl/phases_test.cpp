// A profiled step of fronts books time on every phase that it has apart from the others.
#include <cstdio>

#include "simulations.hpp"

namespace {

using namespace mbs;  // NOLINT: a test of this implementation alone

/// A hanging chain, too long for the step of small scenes.
Model hanging_chain() {
  constexpr int kFree = 20;
  ModelData data;
  data.points.push_back({.name = "A"});
  for (int i = 0; i < kFree; ++i) {
    data.points.push_back({.name = "B", .offset = 2 * i, .position = {i + 1.0, 0.0, 0.0}});
    data.dot_constraints.push_back(
        {.a = i, .b = i + 1, .c = i, .d = i + 1, .value = 1.0, .name = "rod"});
    for (const int axis : {0, 1}) {
      data.mass.push_back({.row = 2 * i + axis, .col = 2 * i + axis, .value = 1.0});
      data.force.push_back(-9.81 * axis);
      data.initial_velocity.push_back(0.0);
    }
  }
  return Model(std::move(data));
}

bool books_all_phases(const char* name, const StepSettings& settings) {
  const Model model = hanging_chain();
  const auto simulation = compiled_ldl::create_double(model, settings);
  const std::vector<double> start(model.initial_position().begin(), model.initial_position().end());
  const std::vector<double> zero(model.variables(), 0.0);
  simulation->set_state(
      {.q = start, .v = zero, .a = zero, .lambda = std::vector<double>(model.constraints(), 0.0)});
  simulation->phases().start();
  const StepOutcome outcome = simulation->step();
  simulation->phases().stop();
  bool all = outcome.status == StepStatus::converged;
  for (const auto ticks : simulation->phases().ticks()) all = all && ticks > 0;
  if (all) return true;
  std::printf("%s: status %d, ticks", name, static_cast<int>(outcome.status));
  for (const auto ticks : simulation->phases().ticks()) std::printf(" %llu", 1ULL * ticks);
  std::printf("\n");
  return false;
}

}  // namespace

int main() {
  bool all = books_all_phases("penalty", {});
  all &= books_all_phases("saddle-point", {.scheme = Scheme::saddle_point});
  all &= books_all_phases("rattle", {.scheme = Scheme::rattle});
  all &= books_all_phases("reused tangent", {.tangent = TangentReuse::kept});
  return all ? 0 : 1;
}
