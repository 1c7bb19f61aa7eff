// Batches: groups of lanes one after the other.
#include "simulations.hpp"

#include "batch/lane_group.hpp"

namespace mbs::compiled_ldl {
namespace {

template <int D>
class Batch final : public BatchSimulation {
 public:
  Batch(std::span<const Model* const> models, std::span<const StepSettings> settings)
      : BatchSimulation(models, settings) {
    for (std::size_t first = 0; first < models.size(); first += Lanes::kCount) {
      const std::size_t count = std::min<std::size_t>(Lanes::kCount, models.size() - first);
      groups_.push_back(std::make_unique<LaneGroup<D>>(models.subspan(first, count),
                                                       settings.subspan(first, count)));
    }
  }

 protected:
  void do_set_state(int lane, const State& state) override {
    groups_[lane / Lanes::kCount]->set_state(lane % Lanes::kCount, state);
  }
  void do_get_state(int lane, State& state) const override {
    groups_[lane / Lanes::kCount]->get_state(lane % Lanes::kCount, state);
  }
  void do_retire(int lane) override { groups_[lane / Lanes::kCount]->retire(lane % Lanes::kCount); }
  void do_step(std::span<StepOutcome> outcomes) override {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      const std::size_t first = i * Lanes::kCount;
      const std::size_t count = std::min<std::size_t>(Lanes::kCount, outcomes.size() - first);
      groups_[i]->step(time(), outcomes.subspan(first, count));
    }
  }

 private:
  std::vector<std::unique_ptr<LaneGroup<D>>> groups_;
};

}  // namespace

std::unique_ptr<BatchSimulation> create_batch(std::span<const Model* const> models,
                                              std::span<const StepSettings> settings) {
  const StepSettings& s = settings.front();
  if (s.scheme != Scheme::penalty || s.multipliers != MultiplierUpdate::every_pass ||
      s.tangent != TangentReuse::none || s.precision != Precision::double_precision ||
      s.geometric_stiffness) {
    throw Unsupported(
        "batches are for the penalty form in double precision, multipliers and tangent of every "
        "pass, no geometric stiffness");
  }
  if (models.front()->dimension() == 2) return std::make_unique<Batch<2>>(models, settings);
  return std::make_unique<Batch<3>>(models, settings);
}

}  // namespace mbs::compiled_ldl
