// A reference simulation a lane.
#include "controls/batches.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include "reference/reference_simulation.hpp"
#include "registry/factory.hpp"

namespace mbs::test {
namespace {

constexpr int kSpoiled = 1;  // lane
constexpr int kWhen = 40;    // step

long steps_of_lanes = 0;

class SoundBatch : public BatchSimulation {
 public:
  SoundBatch(std::span<const Model* const> models, std::span<const StepSettings> settings)
      : BatchSimulation(models, settings) {
    for (std::size_t i = 0; i < models.size(); ++i) {
      simulations_.push_back(std::make_unique<ReferenceSimulation>(*models[i], settings[i]));
    }
  }

 protected:
  void do_set_state(int lane, const State& state) override { at(lane).set_state(state); }
  void do_get_state(int lane, State& state) const override {
    simulations_[static_cast<std::size_t>(lane)]->get_state(state);
  }
  void do_step(std::span<StepOutcome> outcomes) override {
    ++step_;
    for (int lane = 0; lane < lanes(); ++lane) {
      if (is_retired(lane)) continue;
      outcomes[static_cast<std::size_t>(lane)] = at(lane).step();
      ++steps_of_lanes;
    }
  }
  [[nodiscard]] bool is_spoiled(int lane) const { return lane == kSpoiled && step_ >= kWhen; }
  ReferenceSimulation& at(int lane) { return *simulations_[static_cast<std::size_t>(lane)]; }

  int step_ = 0;

 private:
  std::vector<std::unique_ptr<ReferenceSimulation>> simulations_;
};

class LostLane final : public SoundBatch {
  using SoundBatch::SoundBatch;
  void do_get_state(int lane, State& state) const override {
    SoundBatch::do_get_state(lane, state);
    if (is_spoiled(lane)) std::ranges::fill(state.q, std::numeric_limits<double>::quiet_NaN());
  }
};

class FailedLane final : public SoundBatch {
  using SoundBatch::SoundBatch;
  void do_step(std::span<StepOutcome> outcomes) override {
    SoundBatch::do_step(outcomes);
    if (lanes() > kSpoiled && is_spoiled(kSpoiled)) {
      outcomes[kSpoiled] = {StepStatus::factorization_failed, 1};
    }
  }
};

class ThrowingBatch final : public SoundBatch {
  using SoundBatch::SoundBatch;
  void do_step(std::span<StepOutcome> outcomes) override {
    SoundBatch::do_step(outcomes);
    if (step_ >= kWhen) throw std::runtime_error("the batch is lost");
  }
};

class Leaks final : public SoundBatch {
  using SoundBatch::SoundBatch;
  void do_get_state(int lane, State& state) const override {
    SoundBatch::do_get_state(lane, state);
    for (int other = 0; other < lanes(); ++other) {
      if (is_retired(other)) continue;
      State theirs = state;
      SoundBatch::do_get_state(other, theirs);
      if (!(std::abs(theirs.q[0]) < 1e100)) state.q = theirs.q;  // long double overflows late
    }
  }
};

class Mixes final : public SoundBatch {
 public:
  Mixes(std::span<const Model* const> models, std::span<const StepSettings> settings)
      : SoundBatch(std::vector<const Model*>(models.size(), models[0]), settings) {}
};

/// Models that must be there before the batch of them.
struct OwnModels {
  std::vector<std::unique_ptr<Model>> models;
  std::vector<const Model*> pointers;
};

/// Of each of the `items`, every lane has the `part` of lane 0.
template <auto items, auto part>
class MixesPart final : OwnModels, public SoundBatch {
 public:
  MixesPart(std::span<const Model* const> models, std::span<const StepSettings> settings)
      : OwnModels(mixed(models)), SoundBatch(pointers, settings) {}

 private:
  static OwnModels mixed(std::span<const Model* const> lanes) {
    OwnModels result;
    const ModelData& first = lanes[0]->data();
    for (const Model* lane : lanes) {
      ModelData data = lane->data();
      for (std::size_t i = 0; i < (data.*items).size(); ++i) {
        std::invoke(part, (data.*items)[i]) = std::invoke(part, (first.*items)[i]);
      }
      result.models.push_back(std::make_unique<Model>(std::move(data)));
      result.pointers.push_back(result.models.back().get());
    }
    return result;
  }
};

constexpr auto kRates = [](auto& law) -> auto& { return law.law.by_rate; };
constexpr auto kFactor = [](auto& law) -> auto& { return law.law.factor; };

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<ReferenceSimulation>(model, settings);
}

template <class Batch>
std::unique_ptr<BatchSimulation> create_batch(std::span<const Model* const> models,
                                              std::span<const StepSettings> settings) {
  return std::make_unique<Batch>(models, settings);
}

std::unique_ptr<BatchSimulation> refuse(std::span<const Model* const> /*models*/,
                                        std::span<const StepSettings> /*settings*/) {
  throw Unsupported("no batches today");
}

Variant variant(std::string name, decltype(Variant::create_batch) batch) {
  Variant result;
  result.serves.terms = all_terms();
  result.name = std::move(name);
  result.description = "the reference in batches";
  result.create = create;
  result.create_batch = batch;
  result.batch_lanes = 4;
  return result;
}

}  // namespace

std::vector<Variant> batches() {
  return {
      variant("sound", create_batch<SoundBatch>),
      variant("lost_lane", create_batch<LostLane>),
      variant("failed_lane", create_batch<FailedLane>),
      variant("throws", create_batch<ThrowingBatch>),
      variant("unsupported", refuse),
      variant("leaks", create_batch<Leaks>),
      variant("mixes", create_batch<Mixes>),
      variant("mixes_dampings", create_batch<MixesPart<&ModelData::springs, &Spring::damping>>),
      variant("mixes_lengths", create_batch<MixesPart<&ModelData::springs, &Spring::length>>),
      variant("mixes_torsion_dampings",
              create_batch<MixesPart<&ModelData::torsion_springs, &TorsionSpring::damping>>),
      variant("mixes_angles",
              create_batch<MixesPart<&ModelData::torsion_springs, &TorsionSpring::angle>>),
      variant("mixes_force_rates", create_batch<MixesPart<&ModelData::force_laws, kRates>>),
      variant("mixes_torque_rates", create_batch<MixesPart<&ModelData::torque_laws, kRates>>),
      variant("mixes_factors", create_batch<MixesPart<&ModelData::force_laws, kFactor>>),
      variant("mixes_B",
              create_batch<MixesPart<&ModelData::bilinear_constraints, &BilinearConstraint::B>>),
      variant("mixes_coefficients",
              create_batch<MixesPart<&ModelData::linear_constraints, &LinearConstraint::terms>>),
      variant("mixes_driven_points",
              create_batch<MixesPart<&ModelData::driven_points, &DrivenPoint::position>>),
      variant("mixes_driven_values",
              create_batch<MixesPart<&ModelData::driven_values, &DrivenValue::value>>)};
}

long batch_steps() { return steps_of_lanes; }

}  // namespace mbs::test
