// The multistep method moves the same, bit for bit, whether the state is asked for or not.
#include <cstdio>

#include "simulations.hpp"

namespace {

using namespace mbs;  // NOLINT: a test of this implementation alone

/// A hanging chain of this many free points, with a spring to its end.
Model hanging_chain(int count) {
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
  data.springs.push_back({.a = 0, .b = count, .stiffness = 3.0, .length = 1.0, .name = "spring"});
  return Model(std::move(data));
}

State state_after(const Model& model, int steps, bool asks) {
  const auto simulation =
      compiled_ldl::create_double(model, {.step = 1e-3, .scheme = Scheme::multistep6});
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

bool is_same(int count) {
  const Model model = hanging_chain(count);
  const State asked = state_after(model, 300, true), other = state_after(model, 300, false);
  if (asked.q == other.q && asked.v == other.v && asked.a == other.a &&
      asked.lambda == other.lambda) {
    return true;
  }
  std::printf("chain of %d: another motion\n", count);
  return false;
}

}  // namespace

int main() { return is_same(2) && is_same(20) ? 0 : 1; }
