// Keeps what the reference says of a setting.
#include "support/term_models.hpp"

#include <map>

namespace mbs::test {

const ReferenceRun& kept_reference(const std::string& setting, const Scene& scene,
                                   const StepSettings& settings) {
  static std::string kept;
  static std::map<std::string, ReferenceRun> runs;
  if (kept != setting) runs.clear();
  kept = setting;
  const auto found = runs.find(scene.name);
  if (found != runs.end()) return found->second;
  // The gate's take 800 and most of the time of all tests. The states that single steps are
  // compared at are as many.
  constexpr int kSteps = kSlowReference ? 100 : 200;
  return runs.emplace(scene.name, run_reference(scene, settings, kSteps)).first->second;
}

}  // namespace mbs::test
