// Checks at the border of every implementation.
#include "mbs/simulation.hpp"

#include <cmath>
#include <span>

#include "check_state.hpp"

namespace mbs {
namespace {

void check(std::span<const double> values, std::size_t size, const char* name) {
  if (values.size() != size) {
    throw std::invalid_argument(std::string("state.") + name + " has " +
                                std::to_string(values.size()) + " entries, the model needs " +
                                std::to_string(size));
  }
  for (std::size_t i = 0; i < size; ++i) {
    if (!std::isfinite(values[i])) {
      throw std::invalid_argument(std::string("state.") + name + "[" + std::to_string(i) +
                                  "] is not finite");
    }
  }
}

}  // namespace

void check_state(const State& state, int variables, int constraints) {
  const auto n = static_cast<std::size_t>(variables);
  check(state.q, n, "q");
  check(state.v, n, "v");
  check(state.a, n, "a");
  check(state.lambda, static_cast<std::size_t>(constraints), "lambda");
  if (!std::isfinite(state.t)) throw std::invalid_argument("state.t is not finite");
}

void Simulation::set_state(const State& state) {
  check_state(state, variables_, constraints_);
  start_ = state.t;
  steps_ = 0;
  do_set_state(state);
}

void Simulation::get_state(State& state) const {
  const auto n = static_cast<std::size_t>(variables_);
  state.q.resize(n);
  state.v.resize(n);
  state.a.resize(n);
  state.lambda.resize(static_cast<std::size_t>(constraints_));
  do_get_state(state);
  state.t = time();
}

}  // namespace mbs
