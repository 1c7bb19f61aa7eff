// The outcome of a judged run that went to its end, and by when it was beyond what is accurate.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "printable.hpp"
#include "run/judged_run.hpp"

namespace mbs {
namespace {

/// What may bring forces and accelerations closer to those of the motion.
std::string force_cure(const StepSettings& settings) {
  if (settings.projections != Projections::both || settings.projections_every > 1) {
    return ": --projections both in every step";
  }
  return settings.scheme == Scheme::penalty
             ? ": a shorter step, or --scheme saddle-point if it is rounding"
             : ": a shorter step may help";
}

}  // namespace

/// The outcome of a run that went to its end.
void JudgedRun::conclude() {
  is_over_ = true;
  if (adds_local_errors_) {
    summary_.local_error_sum = judge_.ahead_max() + local_errors_.worst().sum;
  }
  note_beyond(steps_);
  summary_.branch_doubt = watch_.doubt();
  if (half_ && summary_.branch_doubt.empty() && !watch_.passage().empty()) {
    summary_.branch_doubt = watch_.passage() +
                            ", where half the step goes the same way: it does not tell whether it "
                            "is the right one";
  }
  const double share = static_cast<double>(summary_.steps_at_limit) / static_cast<double>(steps_);
  if (share > RunBounds{}.pass_limit_share) {
    summary_.status = RunStatus::not_converged;
    summary_.reason = fmt::format(
        "{} of {} steps ended at the limit of {} passes (allowed {:g} %): a shorter step, a larger "
        "--tolerance or --max-passes may help",
        summary_.steps_at_limit, steps_, settings_.step.max_passes,
        100 * RunBounds{}.pass_limit_share);
    return;
  }
  const auto add = [this](const std::string& reason) {
    if (!summary_.reason.empty() && !reason.empty()) summary_.reason += "; ";
    summary_.reason += reason;
  };
  add(judge_.degradation());
  add(beyond_estimates());
  add(watch_.doubt());
  if (!summary_.reason.empty()) summary_.reason += ": a shorter step may help";
  summary_.failed_at = beyond_since_;
  summary_.forces_lost = forces_.beyond();
  if (!summary_.forces_lost.empty()) {
    summary_.forces_lost += force_cure(settings_.step);
    add(summary_.forces_lost);
  }
  if (!summary_.reason.empty()) {
    summary_.status = RunStatus::degraded;
  } else if (!summary_.branch_doubt.empty()) {
    summary_.status = RunStatus::plausible;
    summary_.reason = summary_.branch_doubt;
  } else if (!judge_.knows_exact_motion() && !half_) {
    summary_.status = RunStatus::plausible;
    summary_.reason = "no exact motion is known; --half-step estimates the position error";
  }
}

/// Looks at some 32 places of a run, as sums and figures grow. What was beyond its bound against
/// little, and no longer is once there is more, does not count.
void JudgedRun::note_beyond(long step) {
  if (step < next_noted_ && step < steps_) return;
  next_noted_ = step + std::max(1L, steps_ / 32);
  if (!is_beyond()) {
    beyond_since_.reset();
  } else if (!beyond_since_) {
    beyond_since_ = time(step);
  }
}

bool JudgedRun::is_beyond() const {
  constexpr AccurateBounds accurate;
  return judge_.is_degraded() || forces_.is_beyond() ||
         (half_ && !(half_->share_max() <= accurate.estimated_error)) ||
         (adds_local_errors_ && !(local_share() <= accurate.local_error));
}

double JudgedRun::local_share() const {
  return judge_.ahead_max() / judge_.length() + local_errors_.worst().share;
}

std::string JudgedRun::beyond_estimates() const {
  constexpr AccurateBounds accurate;
  if (half_ && !std::isfinite(half_->position_error_max())) {
    return "the run with half the step was lost, so that the position error is not known";
  }
  if (half_ && !(half_->share_max() <= accurate.estimated_error)) {
    return fmt::format(
        "estimated position error {:.1e} m at most, {:.2g} % of a length at most, at {} (ok to "
        "{:g} %)",
        half_->position_error_max(), 100 * half_->share_max(), printable(half_->farthest_off(), 60),
        100 * accurate.estimated_error);
  }
  if (!adds_local_errors_ || local_share() <= accurate.local_error) return "";
  return fmt::format("local errors add up to {:.1e} m, {:.2g} % of the length at {} (ok to {:g} %)",
                     *summary_.local_error_sum, 100 * local_share(),
                     printable(local_errors_.worst().point, 60), 100 * accurate.local_error);
}

}  // namespace mbs
