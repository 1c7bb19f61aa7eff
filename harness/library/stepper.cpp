// One scene, one simulation, its inputs and outputs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "library/content.hpp"
#include "printable.hpp"
#include "registry/factory.hpp"
#include "run/initial_state.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/json_node.hpp"

namespace mbs {
namespace {

std::string listed(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

/// Whether the driver's value is this input: it follows.
bool is_of(const Driver& driver, const Input& input) {
  const TimeFunction::Sample before = *input.now;
  *input.now = {0.0};
  const double at_0 = driver.value.at(0.0).value;
  *input.now = {1.0};
  const double at_1 = driver.value.at(0.0).value;
  *input.now = before;
  return at_0 != at_1;
}

/// Throws Refused for what a scene file would refuse as the start of `input`.
void require(const Input& input, const InputRange& range, const TimeFunction::Sample& to) {
  const auto require_in = [&](const char* what, double value, double least, double most,
                              const std::string& allowed) {
    if (value >= least && value <= most) return;
    throw Refused(
        fmt::format("input '{}': found {} {:g}, allowed is {}", input.name, what, value, allowed));
  };
  const auto require_number = [&](const char* what, double value) {
    if (std::abs(value) <= kLargestNumber) return;
    require_in(what, value, -kLargestNumber, kLargestNumber,
               fmt::format("a number of magnitude up to {:g}", kLargestNumber));
  };
  require_number("the value", to.value);
  require_number("the rate", to.rate);
  require_number("the acceleration", to.acceleration);
  require_in("the value", to.value, range.least, range.most, range.allowed);
}

}  // namespace

std::vector<InputRange> input_ranges(const Scene& scene) {
  std::vector<InputRange> ranges;
  for (const Input& input : scene.elements.inputs) {
    InputRange& range = ranges.emplace_back();
    for (const Driver& driver : scene.elements.drivers) {
      if (driver.range.empty() || !is_of(driver, input)) continue;
      range.least = std::max(range.least, driver.least);
      range.most = std::min(range.most, driver.most);
      if (range.allowed.find(driver.range) == std::string::npos)
        range.allowed += (range.allowed.empty() ? "" : " and ") + driver.range;
    }
    require(input, range, *input.now);
  }
  return ranges;
}

int index_of(std::string_view name, const std::vector<std::string>& names, const char* what) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  throw Refused(
      fmt::format("the scene has no {} '{}': there are {}", what, printable(name), listed(names)));
}

std::size_t place_of(int index, const std::vector<std::string>& names, const char* what) {
  if (index >= 0 && static_cast<std::size_t>(index) < names.size())
    return static_cast<std::size_t>(index);
  throw Refused(
      fmt::format("the scene has no {} {}: from 0 on there are {}", what, index, listed(names)));
}

StepSettings chosen_settings(const Scene& scene, StepSettings settings) {
  require_step(settings.step);
  require_combination(settings);
  settings = chosen(scene.model, settings);
  RunSettings first;
  first.step = settings;
  first.duration = settings.step;
  require_duration(scene, first);
  return settings;
}

Stepper::Content::Content(const SceneDocument::Content& from, const StepperOptions& options)
    : scene(from.scene()),
      ranges(input_ranges(scene)),
      choice(choose(scene, options)),
      settings(chosen_settings(scene, choice.settings)),
      identity(std::hash<std::string>{}(from.document.dump() + settings_json(settings).dump())),
      values(scene),
      numbers(values.columns().size()) {
  for (const Input& input : scene.elements.inputs) input_names.push_back(input.name);
}

const std::vector<std::string>& Stepper::Content::output_names() const { return values.columns(); }

void Stepper::Content::set_input(int input, double value, double rate, double acceleration) {
  const std::size_t place = place_of(input, input_names, "input");
  const Input& of = scene.elements.inputs[place];
  const TimeFunction::Sample to{value, rate, acceleration};
  require(of, ranges[place], to);
  *of.now = to;
}

void Stepper::Content::start() {
  try {
    simulation = create_simulation(*choice.variant.variant, scene.model, settings);
  } catch (const Unsupported& error) {
    throw Unsupported(fmt::format("{}: {}", choice.variant.name, error.what()));
  }
  state = initial_state(scene.model);
  simulation->set_state(state);
  follow();
}

std::span<const double> Stepper::Content::outputs() {
  follow();
  values.values(numbers);
  return numbers;
}

Stepper::Stepper(const SceneDocument& scene, const StepperOptions& options) {
  content_ = refusing([&] { return std::make_unique<Content>(*scene.content_, options); });
  refusing([&] {
    content_->start();
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
  const StepOutcome outcome = content_->simulation->step();
  if (content_->values.has_angles() && outcome.status != StepStatus::factorization_failed) {
    static_cast<void>(state());
    content_->follow();
  }
  return outcome;
}

StepOutcome Stepper::step(long steps) {
  if (steps < 1) throw Refused(fmt::format("found {} steps, allowed are 1 or more", steps));
  StepOutcome sum{StepStatus::converged, 0, 0};
  for (long i = 0; i < steps && sum.status != StepStatus::factorization_failed; ++i) {
    const StepOutcome one = step();
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
  moment.identity = content_->identity;
}

void Stepper::restore(const Saved& moment) {
  Content& c = *content_;
  const auto& inputs = c.scene.elements.inputs;
  if (moment.identity != c.identity || moment.inputs.size() != inputs.size() ||
      moment.angles.size() != c.values.angles().size()) {
    throw Refused(
        "what was saved is of another scene or other settings, allowed is what a Stepper of the "
        "same document and settings saved");
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) require(inputs[i], c.ranges[i], moment.inputs[i]);
  for (std::size_t i = 0; i < moment.angles.size(); ++i) {
    if (std::isfinite(moment.angles[i])) continue;
    throw Refused(
        fmt::format("angles[{}] is {:g}, allowed is a finite number", i, moment.angles[i]));
  }
  refusing([&] {
    c.simulation->set_state(moment.state);
    return 0;
  });
  c.state = moment.state;
  c.is_current = true;
  c.values.set_angles(moment.angles);
  for (std::size_t i = 0; i < inputs.size(); ++i) *inputs[i].now = moment.inputs[i];
}

}  // namespace mbs
