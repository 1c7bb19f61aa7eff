// One scene, one simulation, its inputs and outputs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "library/content.hpp"
#include "registry/factory.hpp"
#include "run/initial_state.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

int index_of(std::string_view name, const std::vector<std::string>& names, const char* what) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  throw Refused(fmt::format("the scene has no {} '{}': there are {}", what, name,
                            names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

StepSettings chosen_settings(const Scene& scene, StepSettings settings) {
  require_combination(settings);
  if (settings.penalty == 0.0) settings.penalty = automatic_penalty(scene.model, settings);
  if (settings.tolerance == 0.0) settings.tolerance = automatic_tolerance(scene.model, settings);
  RunSettings first{settings, settings.step};
  require_duration(scene, first);
  return settings;
}

Stepper::Content::Content(const SceneDocument::Content& from, const StepperOptions& options)
    : scene(scene_of(from.document, from.name)),
      choice(choose(scene, options)),
      settings(chosen_settings(scene, choice.settings)),
      values(scene),
      numbers(values.columns().size()) {
  for (const Input& input : scene.elements.inputs) input_names.push_back(input.name);
}

const std::vector<std::string>& Stepper::Content::output_names() const { return values.columns(); }

void Stepper::Content::set_input(int input, double value, double rate, double acceleration) {
  *scene.elements.inputs.at(static_cast<std::size_t>(input)).now = {value, rate, acceleration};
}

std::span<const double> Stepper::Content::outputs() {
  values.follow(state.t, state);
  values.values(numbers);
  return numbers;
}

Stepper::Stepper(const SceneDocument& scene, const StepperOptions& options) {
  content_ = refusing([&] { return std::make_unique<Content>(*scene.content_, options); });
  refusing([&] {
    Content& c = *content_;
    c.simulation = create_simulation(*c.choice.variant.variant, c.scene.model, c.settings);
    c.state = initial_state(c.scene.model);
    c.simulation->set_state(c.state);
    return 0;
  });
}

Stepper::Stepper(Stepper&&) noexcept = default;
Stepper& Stepper::operator=(Stepper&&) noexcept = default;
Stepper::~Stepper() = default;

const std::string& Stepper::implementation() const { return content_->choice.variant.name; }
const StepSettings& Stepper::settings() const { return content_->settings; }
std::span<const std::string> Stepper::input_names() const { return content_->input_names; }
std::span<const std::string> Stepper::output_names() const { return content_->output_names(); }
int Stepper::input(std::string_view name) const {
  return index_of(name, content_->input_names, "input");
}
int Stepper::output(std::string_view name) const {
  return index_of(name, content_->output_names(), "output");
}

void Stepper::set_input(int input, double value, double rate, double acceleration) {
  content_->set_input(input, value, rate, acceleration);
}

StepOutcome Stepper::step() {
  content_->is_current = false;
  return content_->simulation->step();
}

StepOutcome Stepper::step(long steps) {
  content_->is_current = false;
  StepOutcome sum{StepStatus::converged, 0, 0};
  for (long i = 0; i < steps && sum.status != StepStatus::factorization_failed; ++i) {
    const StepOutcome one = content_->simulation->step();
    sum.status = std::max(sum.status, one.status);
    sum.passes += one.passes;
    sum.factorizations += one.factorizations < 0 ? one.passes : one.factorizations;
  }
  return sum;
}

const State& Stepper::state() {
  Content& c = *content_;
  if (!c.is_current) c.simulation->get_state(c.state);
  c.is_current = true;
  return c.state;
}

std::span<const double> Stepper::outputs() {
  static_cast<void>(state());
  return content_->outputs();
}

void Stepper::save(Saved& moment) {
  moment.state = state();
  moment.inputs.clear();
  for (const Input& input : content_->scene.elements.inputs) moment.inputs.push_back(*input.now);
  moment.angles = content_->values.angles();
}

void Stepper::restore(const Saved& moment) {
  Content& c = *content_;
  if (moment.inputs.size() != c.scene.elements.inputs.size() ||
      moment.angles.size() != c.values.angles().size()) {
    throw Refused("what was saved is of another scene");
  }
  refusing([&] {
    c.simulation->set_state(moment.state);
    return 0;
  });
  c.state = moment.state;
  c.is_current = true;
  c.values.set_angles(moment.angles);
  for (std::size_t i = 0; i < moment.inputs.size(); ++i) {
    *c.scene.elements.inputs[i].now = moment.inputs[i];
  }
}

}  // namespace mbs
