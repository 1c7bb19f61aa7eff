// The border of batches: what fits into one, and what is checked for every implementation.
#include "mbs/batch.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "controls/batches.hpp"
#include "model_math/monotone_curve.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

/// `model` with other masses, forces and velocities.
Model heavier(const Model& model, double factor) {
  ModelData data = model.data();
  for (MassEntry& entry : data.mass) entry.value *= factor;
  for (double& force : data.force) force *= factor * factor;
  return Model(std::move(data));
}

class Batch : public ::testing::Test {
 protected:
  std::unique_ptr<BatchSimulation> create() {
    std::vector<const Model*> models;
    std::vector<StepSettings> settings;
    for (const Model& model : models_) {
      models.push_back(&model);
      settings.push_back(chosen(model));
    }
    return test::batches()[0].create_batch(models, settings);
  }
  [[nodiscard]] State start(int lane) const {
    return initial_state(models_[static_cast<std::size_t>(lane)]);
  }

  Model base_ = load_scene("four-bar:2").model;
  std::vector<Model> models_{base_, heavier(base_, 2.0), heavier(base_, 0.5)};
};

TEST_F(Batch, LanesMoveAsSimulationsDo) {
  const auto batch = create();
  ASSERT_EQ(batch->lanes(), 3);
  for (int lane = 0; lane < 3; ++lane) batch->set_state(lane, start(lane));
  std::vector<StepOutcome> outcomes(3);
  for (int i = 0; i < 50; ++i) batch->step(outcomes);
  for (int lane = 0; lane < 3; ++lane) {
    const Model& model = models_[static_cast<std::size_t>(lane)];
    const auto alone = test::batches()[0].create(model, chosen(model));
    alone->set_state(start(lane));
    for (int i = 0; i < 50; ++i) static_cast<void>(alone->step());
    State expected, actual;
    alone->get_state(expected);
    batch->get_state(lane, actual);
    EXPECT_EQ(actual.q, expected.q) << lane;
    EXPECT_EQ(actual.t, expected.t);
  }
}

TEST_F(Batch, RetiredLanesTakeNoPart) {
  const auto batch = create();
  for (int lane = 0; lane < 3; ++lane) batch->set_state(lane, start(lane));
  batch->retire(1);
  EXPECT_TRUE(batch->is_retired(1));
  std::vector<StepOutcome> outcomes(3, {StepStatus::converged, -7});
  const long before = test::batch_steps();
  batch->step(outcomes);
  EXPECT_EQ(test::batch_steps() - before, 2);
  EXPECT_GT(outcomes[0].passes, 0);
  EXPECT_EQ(outcomes[1].passes, -7);
  State state;
  EXPECT_THROW(batch->get_state(1, state), std::logic_error);
  EXPECT_NO_THROW(batch->get_state(2, state));
  EXPECT_THROW(batch->retire(3), std::out_of_range);
}

TEST_F(Batch, EveryLaneIsSetToOneTimeFirst) {
  const auto batch = create();
  std::vector<StepOutcome> outcomes(3);
  EXPECT_THROW(batch->step(outcomes), std::logic_error);
  for (int lane = 0; lane < 3; ++lane) batch->set_state(lane, start(lane));
  State late = start(1);
  late.t = 0.5;
  batch->set_state(1, late);
  EXPECT_THROW(batch->step(outcomes), std::logic_error);
  batch->set_state(1, start(1));
  EXPECT_NO_THROW(batch->step(outcomes));
  batch->set_state(0, start(0));  // begins anew
  EXPECT_THROW(batch->step(outcomes), std::logic_error);
  batch->set_state(1, start(1));
  batch->retire(2);
  EXPECT_NO_THROW(batch->step(outcomes));
  EXPECT_THROW(batch->step(std::span(outcomes).first(2)), std::invalid_argument);
}

TEST_F(Batch, StatesAreChecked) {
  const auto batch = create();
  State bad = start(0);
  bad.v[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(batch->set_state(0, bad), std::invalid_argument);
  bad = start(0);
  bad.lambda.pop_back();
  EXPECT_THROW(batch->set_state(0, bad), std::invalid_argument);
  EXPECT_THROW(batch->set_state(3, start(0)), std::out_of_range);
}

TEST_F(Batch, OnlyOneShapeFits) {
  models_.push_back(load_scene("four-bar:3").model);
  EXPECT_THROW(create(), std::invalid_argument);
  models_.clear();
  EXPECT_THROW(create(), std::invalid_argument);
}

TEST(BatchShape, IsEverythingButValues) {
  const Model model = test::spatial_pendulum().model;
  EXPECT_TRUE(have_same_shape(model, heavier(model, 3.0)));
  const auto differs = [&model](auto change) {
    ModelData data = model.data();
    change(data);
    return !have_same_shape(model, Model(std::move(data)));
  };
  EXPECT_FALSE(differs([](ModelData& data) { data.points[0].position[0] = 0.25; }));
  EXPECT_FALSE(differs([](ModelData& data) { data.dot_constraints[0].value = 4.0; }));
  EXPECT_TRUE(differs([](ModelData& data) { data.dot_constraints[3].d = 1; }));
  EXPECT_TRUE(differs([](ModelData& data) { data.dot_constraints.pop_back(); }));
  EXPECT_TRUE(differs([](ModelData& data) { data.linear_constraints[0].terms[0].coordinate = 7; }));
  EXPECT_TRUE(differs([](ModelData& data) {
    std::erase_if(data.mass,
                  [](const MassEntry& entry) { return entry.row == 3 && entry.col == 0; });
  }));
  EXPECT_TRUE(differs([](ModelData& data) { data.points[2].is_vector = true; }));
  const auto with_spring = [&model](double stiffness, double damping) {
    ModelData data = model.data();
    data.springs.push_back({1, 3, stiffness, damping, 0.0, "s"});
    return Model(std::move(data));
  };
  EXPECT_FALSE(have_same_shape(model, with_spring(1.0, 0.0)));
  EXPECT_TRUE(have_same_shape(with_spring(2.0, 0.0), with_spring(1.0, 0.0)));
  EXPECT_FALSE(have_same_shape(with_spring(2.0, 0.0), with_spring(2.0, 1.0)));
  const auto with_law = [&model](const std::vector<double>& forces) {
    ModelData data = model.data();
    std::vector<double> lengths(forces.size());
    std::iota(lengths.begin(), lengths.end(), 1.0);
    data.force_laws.push_back({1, 3, {monotone_curve(lengths, forces)}, "l"});
    return Model(std::move(data));
  };
  EXPECT_FALSE(have_same_shape(model, with_law({1.0, 2.0})));
  EXPECT_TRUE(have_same_shape(with_law({1.0, 2.0}), with_law({1.0, 3.0})));
  EXPECT_FALSE(have_same_shape(with_law({1.0, 2.0}), with_law({1.0, 2.0, 3.0})));
}

TEST(BatchShape, MethodsDifferInAllButPenaltyAndTolerance) {
  StepSettings other{.penalty = 1e8, .tolerance = 1e-9};
  EXPECT_TRUE(have_same_method(StepSettings{}, other));
  other.projections_every = 2;
  EXPECT_FALSE(have_same_method(StepSettings{}, other));
  other = {};
  other.step *= 2;
  EXPECT_FALSE(have_same_method(StepSettings{}, other));
}

}  // namespace
}  // namespace mbs
