// The rungs that look into one step: what each compares, by which equation, and how it is usually
// got wrong.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

/// A quantity that differs from the reference's.
struct Finding {
  std::string quantity;                    ///< "Phi_q"
  std::string row;                         ///< "row 0 'A0B0', column B0.x"; empty: of the whole
  std::optional<double> value, reference;  ///< none: not a number, or no number at all
  std::string detail;                      ///< one line: how much of it differs, and how
};

/// A rung of the ladder that compares parts of one step.
struct StepRung {
  enum class Look { shown, one_pass, velocity, both };  ///< FirstPass; one pass, so projected

  std::string name;      ///< "Phi_q"
  std::string equation;  ///< "Eqs. (7), (8)"
  Look look;
  std::vector<std::string> mistakes;  ///< a line each, the most usual first
};

/// predict, Phi, Phi_q, f, T, Delta q, lambda, v', a'.
const std::vector<StepRung>& step_rungs();

/// The state at which step rungs look: `state` of `model`, moved off its constraints by 0.1 mm,
/// with multipliers of the size of `penalty` times that, so that every term of the equations shows.
State moved_state(const Model& model, State state, double penalty);

/// Makes a simulation with other settings.
using Maker = std::function<std::unique_ptr<Simulation>(const StepSettings&)>;

struct Compared {
  bool is_shown = true;            ///< false: the simulation does not show it
  std::optional<Finding> finding;  ///< none: as the reference has it
};

/// Compares what `rung` looks at in the step of `make`'s simulation from `state` with the
/// reference's. Rounding, amplified by the condition of T, moves it by up to some 1e-7 of its
/// largest entry; 1e-6 is allowed, of the projected a' 1e-6 of the a' that it is made of. Of f and
/// T, which nothing amplifies, 3e-12: M and Q are small in them.
Compared compare_step(const StepRung& rung, const Maker& make, const Model& model,
                      const StepSettings& settings, const State& state);

/// The entry of `x`, a vector of n or of m with the name `name`, that differs most from that of
/// `y`, if one differs by more than `allowed`.
std::optional<Finding> compare_values(const Model& model, const std::string& name,
                                      const std::vector<double>& x, const std::vector<double>& y,
                                      double allowed);

}  // namespace mbs
