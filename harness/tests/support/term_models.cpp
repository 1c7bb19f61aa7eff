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
  return runs.emplace(scene.name, run_reference(scene, settings)).first->second;
}

}  // namespace mbs::test
