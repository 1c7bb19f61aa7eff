// Steps of fronts: a profiled one tells its phases apart; the multistep method moves the same, bit
// for bit, whether the state is asked for or not.
#include <cstdio>

#include "simulations.hpp"

namespace {

using namespace mbs;  // NOLINT: a test of this implementation alone

/// A hanging chain of this many free points.
ModelData hanging_chain(int count) {
  ModelData data;
  data.points.push_back({.name = "A"});
  for (int i = 0; i < count; ++i) {
    data.points.push_back({.name = "B", .offset = 2 * i, .position = {i + 1.0, 0.0, 0.0}});
    data.dot_constraints.push_back(
        {.a = i, .b = i + 1, .c = i, .d = i + 1, .value = 1.0, .name = "rod"});
    for (const int axis : {0, 1}) {
      data.mass.push_back({.row = 2 * i + axis, .col = 2 * i + axis, .value = 1.0});
      data.force.push_back(-9.81 * axis);
      data.initial_velocity.push_back(0.0);
    }
  }
  return data;
}

bool books_all_phases(const char* name, StepSettings settings) {
  settings.penalty = 1e8;
  settings.tolerance = 1e-9;
  const Model model(hanging_chain(20));  // too long for the step of small scenes
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

State state_after(const Model& model, int steps, bool asks) {
  const auto simulation = compiled_ldl::create_double(
      model, {.step = 1e-3, .penalty = 1e8, .tolerance = 1e-9, .scheme = Scheme::multistep6});
  const std::vector<double> start(model.initial_position().begin(), model.initial_position().end());
  const std::vector<double> zero(model.variables(), 0.0);
  State state{
      .q = start, .v = zero, .a = zero, .lambda = std::vector<double>(model.constraints(), 0.0)};
  simulation->set_state(state);
  for (int i = 0; i < steps; ++i) {
    if (simulation->step().status != StepStatus::converged) std::printf("step %d\n", i);
    if (asks) simulation->get_state(state);
    if (asks) simulation->get_state(state);  // as it is by now
  }
  simulation->get_state(state);
  return state;
}

bool asking_changes_nothing(int count) {
  ModelData data = hanging_chain(count);
  data.springs.push_back({.a = 0, .b = count, .stiffness = 3.0, .length = 1.0, .name = "spring"});
  const Model model(std::move(data));
  const State asked = state_after(model, 300, true), other = state_after(model, 300, false);
  if (asked.q == other.q && asked.v == other.v && asked.a == other.a &&
      asked.lambda == other.lambda) {
    return true;
  }
  std::printf("chain of %d: another motion\n", count);
  return false;
}

}  // namespace

int main() {
  bool all = books_all_phases("penalty", {});
  all &= books_all_phases("saddle-point", {.scheme = Scheme::saddle_point});
  all &= books_all_phases("rattle", {.scheme = Scheme::rattle});
  all &= books_all_phases("reused tangent", {.tangent = TangentReuse::kept});
  all &= asking_changes_nothing(2) && asking_changes_nothing(20);
  return all ? 0 : 1;
}
