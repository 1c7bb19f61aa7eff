// Small models that hold every term of the equations, each alone and all together.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "check/reference_run.hpp"
#include "mbs/model.hpp"

namespace mbs::test {

/// Sanitizers make the reference slow: with them a few models, and one variant a folder, must do.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSlowReference = true;
#else
inline constexpr bool kSlowReference = false;
#endif

struct TermModel {
  std::string name;
  Model model;
};

/// How GoogleTest names it.
inline void PrintTo(const TermModel& model, std::ostream* out) { *out << model.name; }

/// Mechanisms of a few points in two and three dimensions, each with one kind of term and one with
/// all of them; their start fulfils the constraints, velocities included.
std::vector<TermModel> term_models();

/// What the reference makes of `scene`, a model of term_models(). Runs are kept until `setting`, a
/// name for all of `settings`, is another: they cost far more than what tests hold against them,
/// variant by variant.
const ReferenceRun& kept_reference(const std::string& setting, const Scene& scene,
                                   const StepSettings& settings);

}  // namespace mbs::test
