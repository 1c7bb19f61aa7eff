// Small models that hold every term of the equations, each alone and all together.
#pragma once

#include <ostream>
#include <string>
#include <vector>

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

}  // namespace mbs::test
