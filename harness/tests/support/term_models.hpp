// What tests of terms share: how models are printed, and the reference's runs.
#pragma once

#include <ostream>
#include <string>

#include "check/reference_run.hpp"
#include "ladder/term_models.hpp"

namespace mbs {

/// How GoogleTest names them.
inline void PrintTo(const TermModel& model, std::ostream* out) { *out << model.name; }
inline void PrintTo(const SettingCase& setting, std::ostream* out) { *out << setting.name; }

namespace test {

/// Sanitizers make the reference slow: with them a few models, and one variant a folder, must do.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSlowReference = true;
#else
inline constexpr bool kSlowReference = false;
#endif

/// What the reference makes of `scene`, a model of term_models(). Runs are kept until `setting`, a
/// name for all of `settings`, is another: they cost far more than what tests hold against them,
/// variant by variant.
const ReferenceRun& kept_reference(const std::string& setting, const Scene& scene,
                                   const StepSettings& settings);

}  // namespace test
}  // namespace mbs
