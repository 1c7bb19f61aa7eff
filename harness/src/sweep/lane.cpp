// One lane by run(), several by a batch of which each lane is judged like a run.
#include "sweep/lane.hpp"

#include <algorithm>
#include <memory>
#include <new>
#include <optional>

#include "registry/factory.hpp"
#include "run/initial_state.hpp"
#include "run/judged_run.hpp"

namespace mbs {
namespace {

/// Went to its end, so that its figures are those of the whole duration.
bool is_complete(const RunSummary& summary) {
  return is_finished(summary.status) || summary.status == RunStatus::not_converged;
}

void store(Lane& lane, RunSummary summary, const OutputExtremes& extremes) {
  if (is_complete(summary)) lane.outputs = extremes.columns();
  lane.summary = std::move(summary);
}

/// States are copied out for those who ask only.
Observer observer(const Scene& scene, OutputExtremes& extremes) {
  if (scene.elements.outputs.empty()) return {};
  return [&extremes](long /*step*/, double t, const State& state) { extremes.follow(t, state); };
}

void run_alone(Lane& lane, const Variant& variant) {
  OutputExtremes extremes(lane.scene);
  store(lane, run(lane.scene, variant, lane.settings, observer(lane.scene, extremes)), extremes);
}

/// A lane of a batch that is judged.
class BatchLane {
 public:
  BatchLane(Lane& lane, const Variant& variant, BatchSimulation& batch, int index)
      : lane_(lane),
        variant_(variant),
        batch_(batch),
        index_(index),
        extremes_(lane.scene),
        start_(initial_state(lane.scene.model)),
        judged_(lane.scene, lane.settings, start_, observer(lane.scene, extremes_)) {}

  void begin() {
    batch_.set_state(index_, start_);
    guard([this] {
      judged_.begin({.get_state = [this](State& state) { batch_.get_state(index_, state); },
                     .again = [this]() -> Simulation& { return again(); },
                     .create =
                         [this](const StepSettings& step) {
                           return create_simulation(variant_, lane_.scene.model, step);
                         },
                     .model = &lane_.scene.model,
                     .is_again_another = true});
    });
  }
  void take(const StepOutcome& outcome) {
    if (judged_.is_over()) return;
    guard([&] { judged_.take(outcome); });
  }
  [[nodiscard]] bool is_over() const { return judged_.is_over(); }
  void finish() { store(lane_, judged_.finish(), extremes_); }

 private:
  /// A batch cannot set one lane back; a simulation of this lane alone can.
  Simulation& again() {
    if (!again_) again_ = create_simulation(variant_, lane_.scene.model, lane_.settings.step);
    return *again_;
  }
  /// What goes wrong here is of this lane; the batch goes on without it.
  template <class Work>
  void guard(Work work) {
    try {
      work();
    } catch (...) {
      judged_.take_exception();
    }
    if (judged_.is_over()) batch_.retire(index_);
  }

  Lane& lane_;
  const Variant& variant_;
  BatchSimulation& batch_;
  int index_;
  OutputExtremes extremes_;
  State start_;
  std::unique_ptr<Simulation> again_;
  JudgedRun judged_;
};

void run_batch(BatchSimulation& batch, std::span<Lane> lanes, const Variant& variant) {
  std::vector<std::unique_ptr<BatchLane>> running;
  for (Lane& lane : lanes) {
    const int index = static_cast<int>(running.size());
    running.push_back(std::make_unique<BatchLane>(lane, variant, batch, index));
  }
  for (const auto& lane : running) lane->begin();
  std::vector<StepOutcome> outcomes(lanes.size());
  const auto is_over = [](const auto& lane) { return lane->is_over(); };
  while (!std::ranges::all_of(running, is_over)) {
    batch.step(outcomes);
    for (std::size_t i = 0; i < running.size(); ++i) running[i]->take(outcomes[i]);
  }
  for (const auto& lane : running) lane->finish();
}

/// Null where the variant does not offer a batch; Unsupported if not of these models.
std::unique_ptr<BatchSimulation> batch_of(std::span<Lane> lanes, const Variant& variant) {
  if (lanes.size() < 2) return nullptr;
  std::vector<const Model*> models;
  std::vector<StepSettings> settings;
  for (const Lane& lane : lanes) {
    models.push_back(&lane.scene.model);
    settings.push_back(lane.settings.step);
  }
  return create_batch(variant, models, settings);
}

/// False if the batch as a whole failed, so that no lane has an outcome by it.
bool run_side_by_side(std::span<Lane> lanes, const Variant& variant) {
  try {
    const auto batch = batch_of(lanes, variant);
    if (batch) run_batch(*batch, lanes, variant);
    return batch != nullptr;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return false;  // each lane alone tells whose fault it was
  }
}

}  // namespace

bool fit_one_batch(const Lane& a, const Lane& b) {
  return have_same_shape(a.scene.model, b.scene.model) &&
         have_same_method(a.settings.step, b.settings.step) &&
         count_steps(a.settings) == count_steps(b.settings);
}

bool run_lanes(std::span<Lane> lanes, const Variant& variant) {
  if (run_side_by_side(lanes, variant)) return true;
  for (Lane& lane : lanes) run_alone(lane, variant);
  return false;
}

std::size_t lanes_at_once(const Variant& variant) {
  return variant.create_batch == nullptr
             ? 1
             : static_cast<std::size_t>(std::max(variant.batch_lanes, 1));
}

}  // namespace mbs
