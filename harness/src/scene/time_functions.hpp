// The kinds of TimeFunction that a JSON scene can ask for, and what lowering makes of them.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "mbs/time_function.hpp"

namespace mbs {

/// sum of coefficients[k] t^k.
TimeFunction polynomial(std::vector<double> coefficients);

/// offset + amplitude sin(2 pi frequency t + phase); frequency in Hz, phase in rad.
struct Sine {
  double amplitude = 0.0, frequency = 0.0, phase = 0.0, offset = 0.0;
};
TimeFunction sine(const Sine& sine);

/// Natural cubic spline through (times[i], values[i]); beyond them it goes on straight, and end()
/// is the last time. Needs at least two rows and strictly increasing times.
TimeFunction spline(std::vector<double> times, std::vector<double> values);

/// Whatever `now` is when it is asked, at all times: what a program sets from step to step.
TimeFunction input(std::shared_ptr<const TimeFunction::Sample> now);

/// `position`, at rest, whose acceleration is -force: with a DrivenMass of 1 kg it puts the force
/// (N) into Q.
TimeFunction pushing(TimeFunction force, double position);

/// f^2.
TimeFunction square_of(TimeFunction f);

/// amplitude cos(angle + phase).
TimeFunction cosine_of(TimeFunction angle, double amplitude, double phase = 0.0);

/// constant + sum of factor * function; a constant again if all of them are.
using Summands = std::vector<std::pair<double, TimeFunction>>;
TimeFunction combination(const Summands& terms, double constant = 0.0);

/// Row at which a table has a corner or is too coarse: two rules.
///
/// Jump: with D_i the second divided differences at the inner rows, a pair (i, i + 1) is a corner
/// if |D| at one of them exceeds kCornerRatio times |D| at the two rows before and the two after
/// the pair, both inner rows on one side at least (a corner between two rows splits its D among
/// them), and if the slope jumps there by more than kCornerJump of the table's steepest slope
/// (smaller ones are rounding of the values).
///
/// Stray: an inner row is one if the cubic through the four rows nearest by number (in a table of
/// four rows the parabola through the three others) and the straight line between its neighbours
/// both miss its value by more than kStrayShare of the range of the values from three rows before
/// to three after, and by kCornerJump of the range of all.
///
/// Example: |t - 1| at t = 0, 0.1, ..., 2 has D = 0 but for 20 at t = 1: a jump. A single 1 among
/// zeros, and rows that go up and down by turns, stray. A sine is smooth from six rows a period on.
inline constexpr double kCornerRatio = 5.0;
inline constexpr double kStrayShare = 0.2;
inline constexpr double kCornerJump = 0.01;
std::optional<std::size_t> corner_of(const std::vector<double>& times,
                                     const std::vector<double>& values);

}  // namespace mbs
