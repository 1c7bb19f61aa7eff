// What about the settings of a run is likely to spoil it.
#pragma once

#include <string>
#include <vector>

#include "describe/penalty_window.hpp"
#include "describe/structure.hpp"
#include "mbs/simulation.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// A scene of more variables is not warned about its penalty factor: that would take over a second.
inline constexpr int kMostVariablesToWarn = 20'000;

/// How far outside is worth a warning: the window is right to a factor of about ten, and mechanisms
/// that meet no singular position work well below it.
inline constexpr double kFarBelow = 100.0, kFarAbove = 10.0;

/// The automatic factor in single precision is `ok` over 2 s up to so far above what nonlinearity
/// allows.
inline constexpr double kFarAboveByRule = 25.0;

/// In single precision runs are lost from where the window has closed to these factors: where
/// singular positions set the lower bound, and where the slowest mode does.
inline constexpr double kClosedInSingle = 2.0, kClosedBySlowestInSingle = 3.25;

/// Longest step as a share of the shortest period of springs; there the period is 3 % off.
inline constexpr double kLongestShare = 0.1;

/// Newton's tolerance over the automatic one from which the error that it leaves in a step may
/// count.
inline constexpr double kLoosest = 1000.0;

/// Who chose the penalty factor: `--penalty auto`, or a number of the user's.
enum class PenaltyFrom { rule, user };

/// Whether the penalty factor of `settings` is beyond the window, which is for their step, that
/// far, or whether the window is empty by as much; one line, empty if not. It asks for another
/// factor only where the user chose it and one would do; else the step or the form is to change.
std::string penalty_warning(const PenaltyWindow& window, const StepSettings& settings,
                            PenaltyFrom from);

/// 2 pi sqrt(M_ii / K_ii) at the start, the least of the coordinates that swing (C_ii^2 < 4 K_ii
/// M_ii), s; infinite without springs. An estimate.
double shortest_period(const Model& model);

/// Whether `step` (s) is above kLongestShare of shortest_period(); one line, empty if not.
std::string period_warning(const Model& model, double step);

/// Whether the start is a singular position; one line, empty if not.
std::string start_warning(const Model& model, const Structure& structure);

/// Whether the tolerance is above kLoosest times the automatic one; one line, empty if not.
std::string tolerance_warning(const Model& model, const StepSettings& settings);

/// Which outputs are forces of constraints that depend on each other at the start, so that other
/// forces would hold the same motion; one line, empty if none is.
std::string force_warning(const Scene& scene);

/// All that the model tells, one line each.
std::vector<std::string> setting_warnings(const Model& model, const StepSettings& settings,
                                          PenaltyFrom from);

}  // namespace mbs
