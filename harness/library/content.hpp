// What is behind the classes of stepper.hpp.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "mbs/stepper.hpp"
#include "registry/registry.hpp"
#include "registry/setting_names.hpp"
#include "run/output_values.hpp"
#include "scene/scene.hpp"
#include "usage_error.hpp"

namespace mbs {

/// work(), with what users can mend as Refused.
template <class Work>
auto refusing(Work work) {
  try {
    return work();
  } catch (const UsageError& error) {
    throw Refused(error.what());
  } catch (const std::invalid_argument& error) {
    throw Refused(error.what());
  }
}

struct SceneDocument::Content {
  std::string name;
  nlohmann::json document;
};

/// An implementation, and the settings but for what is chosen from the scene.
struct Choice {
  NamedVariant variant;
  StepSettings settings;
};

/// Throws UsageError.
Choice choose(const Scene& scene, const StepperOptions& options);
StepSettings chosen_settings(const Scene& scene, StepSettings settings);

/// All of a Stepper. In a batch: of a lane, without a simulation where the batch has it.
struct Stepper::Content {
  Content(const SceneDocument::Content& from, const StepperOptions& options);

  [[nodiscard]] const std::vector<std::string>& output_names() const;
  void set_input(int input, double value, double rate, double acceleration);
  /// Of `state`, which must be current.
  std::span<const double> outputs();

  Scene scene;
  Choice choice;
  StepSettings settings;
  OutputValues values;  // of `scene`
  std::vector<double> numbers;
  std::vector<std::string> input_names;
  std::unique_ptr<Simulation> simulation;
  State state;
  bool is_current = true;  // `state` is the simulation's
};

}  // namespace mbs
