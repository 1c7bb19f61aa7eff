// Lanes of one batch, or one simulation each.
#include <fmt/format.h>

#include "library/content.hpp"
#include "registry/factory.hpp"
#include "run/initial_state.hpp"

namespace mbs {

struct BatchStepper::Content {
  std::vector<std::unique_ptr<Stepper::Content>> lanes;
  std::vector<StepOutcome> outcomes;
  std::vector<char> has_failed;
  std::unique_ptr<BatchSimulation> batch;  // null: each lane has its simulation
  long steps = 0;

  [[nodiscard]] Stepper::Content& lane(int index) {
    if (index < 0 || index >= static_cast<int>(lanes.size())) {
      throw Refused(fmt::format("found lane {}, allowed is 0 to {}", index, lanes.size() - 1));
    }
    return *lanes[static_cast<std::size_t>(index)];
  }
  void start();
  /// Null where the implementation offers none of these scenes.
  [[nodiscard]] std::unique_ptr<BatchSimulation> side_by_side() const;
};

std::unique_ptr<BatchSimulation> BatchStepper::Content::side_by_side() const {
  std::vector<const Model*> models;
  std::vector<StepSettings> settings;
  for (const auto& lane : lanes) {
    models.push_back(&lane->scene.model);
    settings.push_back(lane->settings);
    if (!have_same_shape(*models.front(), *models.back())) return nullptr;
    if (!have_same_method(settings.front(), settings.back())) return nullptr;
  }
  try {
    return create_batch(*lanes.front()->choice.variant.variant, models, settings);
  } catch (const Unsupported&) {
    return nullptr;  // of batches; alone a lane says so again
  }
}

void BatchStepper::Content::start() {
  if (lanes.size() > 1) batch = side_by_side();
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    Stepper::Content& lane = *lanes[i];
    if (!batch) {
      lane.start();
      continue;
    }
    lane.state = initial_state(lane.scene.model);
    batch->set_state(static_cast<int>(i), lane.state);
    lane.follow();
  }
}

BatchStepper::BatchStepper(std::span<const SceneDocument> scenes, const StepperOptions& options)
    : content_(std::make_unique<Content>()) {
  if (scenes.empty()) throw Refused("a batch needs a scene");
  refusing([&] {
    StepperOptions of_all = options;
    for (const SceneDocument& scene : scenes) {
      content_->lanes.push_back(std::make_unique<Stepper::Content>(*scene.content_, of_all));
      const Stepper::Content& first = *content_->lanes.front();
      const Stepper::Content& last = *content_->lanes.back();
      if (last.input_names != first.input_names || last.output_names() != first.output_names()) {
        throw Refused(
            fmt::format("scene {} of the batch has other inputs or outputs than the first, allowed "
                        "are the same",
                        content_->lanes.size()));
      }
      const Choice& chosen = first.choice;
      of_all.implementation = chosen.variant.name;
      of_all.settings = chosen.settings;
    }
    content_->outcomes.resize(scenes.size());
    content_->has_failed.resize(scenes.size());
    content_->start();
    return 0;
  });
}

BatchStepper::BatchStepper(BatchStepper&&) noexcept = default;
BatchStepper& BatchStepper::operator=(BatchStepper&&) noexcept = default;
BatchStepper::~BatchStepper() = default;

int BatchStepper::lanes() const { return static_cast<int>(content_->lanes.size()); }
bool BatchStepper::is_side_by_side() const { return content_->batch != nullptr; }
const std::string& BatchStepper::implementation() const {
  return content_->lane(0).choice.variant.name;
}
const StepSettings& BatchStepper::settings(int lane) const { return content_->lane(lane).settings; }
std::span<const std::string> BatchStepper::input_names() const {
  return content_->lane(0).input_names;
}
std::span<const std::string> BatchStepper::output_names() const {
  return content_->lane(0).output_names();
}

int BatchStepper::input(std::string_view name) const {
  return index_of(name, content_->lane(0).input_names, "input");
}
int BatchStepper::output(std::string_view name) const {
  return index_of(name, content_->lane(0).output_names(), "output");
}

void BatchStepper::set_input(int lane, int input, double value, double rate, double acceleration) {
  content_->lane(lane).set_input(input, value, rate, acceleration);
}

std::span<const StepOutcome> BatchStepper::step() {
  Content& c = *content_;
  ++c.steps;
  if (c.batch) c.batch->step(c.outcomes);
  for (std::size_t i = 0; i < c.lanes.size(); ++i) {
    if (c.has_failed[i]) {
      c.outcomes[i] = {StepStatus::factorization_failed, 0, 0};
      continue;
    }
    c.lanes[i]->is_current = false;
    if (!c.batch) c.outcomes[i] = c.lanes[i]->simulation->step();
    if (c.outcomes[i].status == StepStatus::factorization_failed) {
      c.has_failed[i] = true;
      if (c.batch) c.batch->retire(static_cast<int>(i));
    } else if (c.lanes[i]->values.has_angles()) {
      static_cast<void>(state(static_cast<int>(i)));
      c.lanes[i]->follow();
    }
  }
  return c.outcomes;
}

double BatchStepper::t() const { return static_cast<double>(content_->steps) * settings(0).step; }

const State& BatchStepper::state(int lane) {
  Stepper::Content& of = content_->lane(lane);
  if (content_->has_failed[static_cast<std::size_t>(lane)] != 0) {
    throw Refused(fmt::format("lane {}: a step of it failed, so it has no state", lane));
  }
  if (!of.is_current && content_->batch) content_->batch->get_state(lane, of.state);
  if (!of.is_current && of.simulation) of.simulation->get_state(of.state);
  of.is_current = true;
  return of.state;
}

std::span<const double> BatchStepper::outputs(int lane) {
  static_cast<void>(state(lane));
  return content_->lane(lane).outputs();
}

}  // namespace mbs
