// Small models that hold every term of the equations, each alone and all together.
#pragma once

#include <string>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

struct TermModel {
  std::string name;  ///< "springs, planar"
  Model model;
  std::string equation;  ///< of paper/README.md, what the term is about
};

/// Mechanisms of a few points in two and three dimensions, each with one kind of term and one with
/// all of them; their start fulfils the constraints, velocities included.
std::vector<TermModel> term_models();

/// The settings that they are checked with: `settings` with a step so short, 0.25 ms, that in 800
/// of them no driver forces what geometry forbids, and automatic penalty and tolerance.
StepSettings term_settings(const Model& model, StepSettings settings = {});

/// Settings beyond the defaults under a name of their own: all choices, and how they combine.
struct SettingCase {
  std::string name;  ///< "saddle_point_kept"
  StepSettings settings;
};
std::vector<SettingCase> setting_cases();

}  // namespace mbs
