// Settings that the harness chooses from the model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

/// The penalty factor `auto`: alpha = (4 / dt^2) beta, at turn = omega dt = 6.8e-3 rad a step
///
///   beta_0 = clamp(30 / s_min, 4e3 / s_mean, 1e7 / s_mean)
///
/// (at least 2 / s_min, as a step of one pass is stable from beta s_min = 1 on; but not if s_min is
/// small only where the motion starts and rounding would then move heavy points by more than 3e-9 l
/// in a pass) and, with x = turn / 6.8e-3 (in single
/// precision turn / 13.6e-3, and 6e4 for 4e6),
///
///   beta = min(beta_0 / x^2, max(beta_0, 4e6 / s_mean))          for shorter steps,
///   beta = max(min(beta_0, 0.6 / (s_row turn^3)), beta_0 / 100)  for longer ones.
///
/// s_min is the smallest eigenvalue above 0 of S = Phi_q M^-1 Phi_q^T at the start, s_mean the mean
/// and s_row the least above 0 of its diagonal with the diagonal of M (m^2/kg); omega is
/// fastest_turning(). The multiplier iteration contracts by 1 / (1 + beta s): the first term asks
/// for a factor of 31 of the slowest mode, the lower bound for 4000 of the mean one, which singular
/// positions need, and the upper bound stays clear of cancellation. The shorter a step, the nearer
/// to a singular position the worst of them ends, where s is as turn^2; the longer, the more of the
/// predictor's error alpha turns into forces: automatic_settings.md here. 1 for a model
/// without constraints.
///
/// The saddle-point form: (4 / dt^2) 15 / (s_min x^2), but from 2.5e7 / s_mean, which is eps = 4e-8
/// s_mean, to 1e10 / s_mean (x = turn / 6.8e-3), and at least 2 / s_min if that is at most 1e14 /
/// s_mean; with factors in single precision 1e6 instead,
/// since eps must be above their rounding. RATTLE: (4 / dt^2) 2e4 / s_mean: a smaller eps does not
/// survive the poles of the multipliers at singular positions; the multistep method, which does not
/// pass them anyway, 1e7, so that two passes are enough. For the step, scheme and precision
/// of `settings`; `smallest`: s_min, where it is known already.
double automatic_penalty(const Model& model, const StepSettings& settings,
                         std::optional<double> smallest = std::nullopt);

/// Diagonal of Phi_q M^-1 Phi_q^T with the diagonal of M, at the start (m), m^2/kg.
std::vector<double> constraint_diagonal(const Model& model);

/// s_mean of the above, m^2/kg; not a number for a model without constraints.
double mean_constraint_eigenvalue(const Model& model);

/// s_row of the above, m^2/kg: the heaviest that a constraint moves, where light unit vectors can
/// make the mean a hundred times as much. Infinite for a model without constraints.
double least_constraint_diagonal(const Model& model);

/// "auto" or a number > 0, for the step and scheme of `settings`. Throws UsageError.
double parse_penalty(const std::string& text, const Model& model, const StepSettings& settings);

/// u of the precision that a step is computed in; of mixed precision that of double.
double unit_roundoff(Precision precision);

/// The lesser of max|q| and the scene's extent, m: constraints see differences of points, so that
/// this is what their rounding is relative to.
double rounding_length(const Model& model);

/// The tolerance `auto`, m: 1e-9 l at 1.25e-3 s and proportional to step^4, at most 1e-6 l, so that
/// what Newton leaves stays below the integrator's own error at every step; in the saddle-point
/// form with a tangent of every pass, which converges quadratically, and without a stiff damper
/// (step c > 2 m in a coordinate), 1e-8 l and step^2: tighter ones are below the noise of solves at
/// singular positions, where passes then go on to their limit. l is that of fastest_turning(), at
/// most 1 m. But not below ten times the rounding noise of a Newton step, which it could not reach:
/// u max|q|, and in the constraints u l_r sqrt(1 + alpha dt^2/4 s_mean) with l_r =
/// rounding_length(); u is that of the precision. For the step, penalty and precision of
/// `settings`.
double automatic_tolerance(const Model& model, const StepSettings& settings);

}  // namespace mbs
