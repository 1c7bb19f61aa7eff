// Settings that the harness chooses from the model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

/// The penalty factor `auto`: alpha = (4 / dt^2) beta. Both trapezoidal forms, which take the same
/// Newton steps in double precision with a tangent of every pass, have
///
///   beta = clamp(15 / (s_min x^2), least / s_mean, most / s_mean),     x = omega dt / 6.8e-3,
///
/// least being 1e6 in the penalty form, whose lambda loses digits to alpha, 2.5e7 in the saddle-
/// point form, and most 1e10. Light parts make s_mean large: in the penalty form, where their own
/// masses may be rounded, most / s_mean is up to 1e10 / s_row, but at most 1e14 / s_mean. And beta
/// is at least 2 / s_min, as a step of one pass is stable from beta s_min = 1 on, if that is at
/// most 1e14 / s_mean (6e13 in the penalty form, and from 1e12 / s_row on only if the mode is as
/// slow everywhere). With factors in single precision the saddle-point form has 1e6 / s_mean, since
/// eps must be above their rounding. RATTLE: 2e4 / s_mean: a smaller eps does not survive the poles
/// of the multipliers at singular positions; the multistep method, which does not pass them anyway,
/// 1e7 / s_mean, so that two passes are enough. The penalty form with kept tangents, a geometric
/// stiffness or factors in single precision has less: automatic_settings.md here. 1 for a model
/// without constraints.
///
/// s_min is the smallest eigenvalue above 0 of S = Phi_q M^-1 Phi_q^T at the start, s_mean the mean
/// and s_row the least above 0 of its diagonal with the diagonal of M (m^2/kg); omega is
/// fastest_turning(). The multiplier iteration contracts by 1 / (1 + beta s), and the shorter a
/// step, the nearer to a singular position the worst of them ends, where s is as (omega dt)^2. For
/// the step, scheme, tangent and precision of `settings`; `smallest`: s_min, where it is known.
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
/// what Newton leaves stays below the integrator's own error at every step; where Newton converges
/// quadratically (a tangent of every pass, not the penalty form in float or with beta s_mean below
/// 5e5, and no stiff damper, step c > 2 m in a coordinate), 1e-8 l and step^2: tighter ones are
/// below the noise of solves at singular positions, where passes then go on to their limit. l is
/// that of fastest_turning(), at most 1 m. But not below ten times the rounding noise of a Newton
/// step, which it could not reach: u max|q|, and in the constraints u l_r sqrt(1 + alpha dt^2/4
/// s_mean) with l_r = rounding_length(); u is that of the precision. For the step, penalty and
/// precision of `settings`.
double automatic_tolerance(const Model& model, const StepSettings& settings);

}  // namespace mbs
