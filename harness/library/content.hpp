// What is behind the classes of stepper.hpp.
#pragma once

#include <cstdint>
#include <limits>
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
#include "scene_file/load_scene.hpp"
#include "usage_error.hpp"

namespace mbs {

/// `text` with what the program calls options called as programmers do: "--max-passes" is
/// max_passes.
std::string without_options(std::string text);

/// work(), with what users can mend as Refused.
template <class Work>
auto refusing(Work work) {
  try {
    return work();
  } catch (const UsageError& error) {
    throw Refused(without_options(error.what()));
  } catch (const std::invalid_argument& error) {
    throw Refused(error.what());
  } catch (const Unsupported& error) {
    throw Unsupported(without_options(error.what()));
  }
}

struct SceneDocument::Content {
  std::string name;
  nlohmann::json document;
  Unused unused = Unused::refused;  // until a number is changed

  [[nodiscard]] Scene scene() const { return scene_of(document, name, unused); }
};

/// An implementation, and the settings but for what is chosen from the scene.
struct Choice {
  NamedVariant variant;
  StepSettings settings;
};

/// Throws UsageError.
Choice choose(const Scene& scene, const StepperOptions& options);
StepSettings chosen_settings(const Scene& scene, StepSettings settings);

/// An input's value may be from `least` to `most`.
struct InputRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  std::string allowed;
};

/// What the scene file allows each input, wherever the scene has it. Throws Refused where one
/// starts elsewhere.
std::vector<InputRange> input_ranges(const Scene& scene);

/// `index` counts `what` of `names`. Throws Refused.
std::size_t place_of(int index, const std::vector<std::string>& names, const char* what);
/// Where `name` is among them. Throws Refused.
int index_of(std::string_view name, const std::vector<std::string>& names, const char* what);

/// All of a Stepper. In a batch: of a lane, without a simulation where the batch has it.
struct Stepper::Content {
  Content(const SceneDocument::Content& from, const StepperOptions& options);

  [[nodiscard]] const std::vector<std::string>& output_names() const;
  /// The simulation, at the scene's start. Throws Unsupported.
  void start();
  void set_input(int input, double value, double rate, double acceleration);
  /// `state`, which must be current, is the next of the motion: for angles, which count turns.
  void follow() { values.follow(state.t, state); }
  /// Of `state`, which must be current.
  std::span<const double> outputs();

  Scene scene;
  std::vector<InputRange> ranges;  // of its inputs
  Choice choice;
  StepSettings settings;
  std::uint64_t identity;  // of the document and `settings`
  OutputValues values;  // of `scene`
  std::vector<double> numbers;
  std::vector<std::string> input_names;
  std::unique_ptr<Simulation> simulation;
  State state;
  bool is_current = true;  // `state` is the simulation's
};

}  // namespace mbs
