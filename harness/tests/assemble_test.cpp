// The start of a scene: what assembly moves, what it leaves alone, what it refuses.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "model_math/consistency.hpp"
#include "scene/scene.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

/// Points of 1 kg, none fixed unless `free` says so, joined by rods without mass.
struct Frame {
  struct Place {
    std::string name;
    double x, y;
    bool free;
    double mass = 1.0;
  };
  struct Bar {
    int a, b;
    double length;
  };
  std::vector<Place> places;
  std::vector<Bar> bars;

  [[nodiscard]] SceneData build(double largest_correction) const {
    SceneData data;
    int n = 0;
    for (const Place& place : places) {
      data.model.points.push_back({place.name, place.free ? n : -1, {place.x, place.y, 0.0}});
      if (!place.free) continue;
      for (int axis = 0; axis < 2; ++axis, ++n) data.model.mass.push_back({n, n, place.mass});
    }
    for (const Bar& bar : bars) {
      const std::string name = places[static_cast<std::size_t>(bar.a)].name + "-" +
                               places[static_cast<std::size_t>(bar.b)].name;
      data.model.dot_constraints.push_back(
          {bar.a, bar.b, bar.a, bar.b, bar.length * bar.length, name});
    }
    data.model.force.resize(static_cast<std::size_t>(n), 0.0);
    data.model.initial_velocity.resize(static_cast<std::size_t>(n), 0.0);
    data.largest_correction = largest_correction;
    return data;
  }
};

double violation(const SceneData& data) {
  const Model model(data.model);
  return position_violation(model, 0.0, model.initial_position()).ratio;
}
double rate_violation(const SceneData& data) {
  const Model model(data.model);
  return velocity_violation(model, 0.0, model.initial_position(), model.initial_velocity()).ratio;
}

std::string refusal(SceneData data) {
  try {
    assemble_start(data, "test.json");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "none";
}

/// f(t) = rate t + offset.
TimeFunction ramp(double rate, double offset) {
  class Ramp final : public TimeFunction::Kind {
   public:
    Ramp(double rate, double offset) : rate_(rate), offset_(offset) {}
    [[nodiscard]] TimeFunction::Sample at(double t) const override {
      return {offset_ + rate_ * t, rate_, 0.0};
    }

   private:
    double rate_, offset_;
  };
  return TimeFunction(std::make_shared<Ramp>(rate, offset));
}

TEST(AssembleStart, LeavesConsistentStartsBitForBit) {
  for (const int loops : {1, 40, 2000}) {
    SceneData data;
    data.model = four_bar(loops);
    // The last bit of a coordinate: rounding of given numbers is no reason to move anything.
    double& x = data.model.points.back().position[0];
    x = std::nextafter(x, 1e9);
    const ModelData before = data.model;
    assemble_start(data, "test");
    for (std::size_t i = 0; i < before.points.size(); ++i) {
      EXPECT_EQ(data.model.points[i].position, before.points[i].position);
    }
    EXPECT_EQ(data.model.initial_velocity, before.initial_velocity);
    EXPECT_EQ(data.assembly.position_correction, 0.0);
    EXPECT_EQ(data.assembly.velocity_correction, 0.0);
    EXPECT_EQ(data.assembly.point, "");
  }
}

TEST(AssembleStart, MovesAPointTheShortestWay) {
  SceneData data = Frame{{{"A", 0, 0, false}, {"B", 0.606, 0.808, true}}, {{0, 1, 1.0}}}.build(0.1);
  assemble_start(data, "test");
  EXPECT_LT(violation(data), 1e-15);
  EXPECT_NEAR(data.model.points[1].position[0], 0.6, 1e-12);
  EXPECT_NEAR(data.model.points[1].position[1], 0.8, 1e-12);
  EXPECT_NEAR(data.assembly.position_correction, 0.01, 1e-12);
  EXPECT_EQ(data.assembly.point, "B");
}

TEST(AssembleStart, MovesHeavyPointsLess) {
  SceneData data =
      Frame{{{"B", 0, 0, true, 1.0}, {"C", 1.1, 0, true, 99.0}}, {{0, 1, 1.0}}}.build(0.1);
  assemble_start(data, "test");
  EXPECT_NEAR(data.model.points[0].position[0], 0.099, 1e-12);
  EXPECT_NEAR(data.model.points[1].position[0], 1.099, 1e-12);
  EXPECT_EQ(data.assembly.point, "B");
}

TEST(AssembleStart, TakesRedundantConstraints) {
  SceneData data;
  data.model = four_bar(3);
  data.model.points[5].position[0] += 0.02;
  data.model.dot_constraints.push_back(data.model.dot_constraints[1]);
  data.model.dot_constraints.push_back(data.model.dot_constraints[5]);
  data.largest_correction = 0.1;
  assemble_start(data, "test");
  EXPECT_LT(violation(data), 1e-14);
  EXPECT_LT(rate_violation(data), 1e-14);
}

TEST(AssembleStart, ReachesSingularPositions) {
  // Stretched: B can only be half-way between A and C, where both rods pull along one line.
  SceneData data = Frame{
      {{"A", 0, 0, false}, {"B", 1.001, 0.01, true}, {"C", 2, 0, false}},
      {{0, 1, 1.0},
       {1, 2, 1.0}}}.build(0.1);
  assemble_start(data, "test");
  EXPECT_LT(violation(data), 1e-10);
  EXPECT_NEAR(data.model.points[1].position[0], 1.0, 1e-6);
  EXPECT_NEAR(data.model.points[1].position[1], 0.0, 1e-4);
}

TEST(AssembleStart, NamesWhatCannotBeAssembled) {
  const Frame frame{{{"A", 0, 0, false}, {"B", 1.2, 0.4, true}, {"C", 3, 0, false}},
                    {{0, 1, 1.0}, {1, 2, 1.0}}};
  const std::string message = refusal(frame.build(10.0));
  EXPECT_TRUE(message.starts_with("test.json: the start cannot be assembled")) << message;
  EXPECT_NE(message.find("worst at A-B"), std::string::npos) << message;
  EXPECT_NE(message.find(": its points are 1.4"), std::string::npos) << message;
  EXPECT_NE(message.find("apart, its length is 1 m"), std::string::npos) << message;
}

TEST(AssembleStart, RefusesLargeCorrections) {
  const Frame frame{{{"A", 0, 0, false}, {"B", 1.25, 0, true}}, {{0, 1, 1.0}}};
  const std::string message = refusal(frame.build(0.2));
  EXPECT_NE(message.find("\"B\" would move by 0.25 m, allowed is 0.2 m"), std::string::npos)
      << message;
  EXPECT_NE(message.find("A-B: its points are 1.25 m apart, its length is 1 m"), std::string::npos)
      << message;
  EXPECT_EQ(refusal(frame.build(0.26)), "none");
}

TEST(AssembleStart, ARefusedStartStaysAsItIs) {
  SceneData data = Frame{{{"A", 0, 0, false}, {"B", 1.25, 0, true}}, {{0, 1, 1.0}}}.build(0.1);
  EXPECT_THROW(assemble_start(data, "test"), UsageError);
  EXPECT_EQ(data.model.points[1].position[0], 1.25);
}

TEST(AssembleStart, OtherPointsFollowAGivenVelocity) {
  SceneData data;
  data.model = four_bar(20);
  std::fill(data.model.initial_velocity.begin() + 2, data.model.initial_velocity.end(), 0.0);
  assemble_start(data, "test");
  for (std::size_t i = 0; i < 42; i += 2) {
    EXPECT_NEAR(data.model.initial_velocity[i], 1.0, 1e-13) << i;
    EXPECT_NEAR(data.model.initial_velocity[i + 1], 0.0, 1e-13) << i;
  }
  EXPECT_EQ(data.model.initial_velocity[0], 1.0);  // the given one, bit for bit
  EXPECT_NEAR(data.assembly.velocity_correction, 1.0, 1e-12);
  EXPECT_EQ(data.assembly.position_correction, 0.0);
}

TEST(AssembleStart, CorrectsApproximateVelocities) {
  SceneData data;
  data.model = four_bar(2);
  data.model.initial_velocity[1] = 0.01;  // B0 along its rod
  assemble_start(data, "test");
  EXPECT_LT(rate_violation(data), 1e-14);
  EXPECT_NEAR(data.model.initial_velocity[1], 0.0, 1e-15);
  EXPECT_NEAR(data.assembly.velocity_correction, 0.01, 1e-3);
}

TEST(AssembleStart, RefusesVelocitiesAgainstTheConstraints) {
  SceneData data = Frame{{{"A", 0, 0, false}, {"B", 0, -2, true}}, {{0, 1, 2.0}}}.build(0.1);
  data.model.initial_velocity = {1.0, 0.5};
  const std::string message = refusal(data);
  EXPECT_NE(message.find("\"B\""), std::string::npos) << message;
  EXPECT_NE(message.find("change by 0.5 m/s, allowed is 0.112 m/s"), std::string::npos) << message;
  EXPECT_NE(message.find("worst is A-B"), std::string::npos) << message;
}

TEST(AssembleStart, DriversSetPointsInMotion) {
  // A moves along x at 3 m/s, B hangs level from it: it must keep up.
  SceneData data = Frame{{{"A", 0, 0, false}, {"B", 1, 0, true}}, {{0, 1, 1.0}}}.build(0.1);
  data.model.driven_points.push_back({0, {ramp(3.0, 0.0), 0.0, 0.0}});
  assemble_start(data, "test");
  EXPECT_NEAR(data.model.initial_velocity[0], 3.0, 1e-14);
  EXPECT_EQ(data.model.initial_velocity[1], 0.0);
}

TEST(AssembleStart, DrivenValuesHoldAtTheStart) {
  // A rod that is 1.05 m long at t = 0 and grows by 0.5 m^2/s.
  SceneData data = Frame{{{"A", 0, 0, false}, {"B", 1, 0, true}}, {{0, 1, 1.0}}}.build(0.1);
  data.model.driven_values.push_back({0, ramp(0.5, 1.05 * 1.05)});
  assemble_start(data, "test");
  EXPECT_NEAR(data.model.points[1].position[0], 1.05, 1e-13);
  EXPECT_NEAR(data.model.initial_velocity[0], 0.5 / (2 * 1.05), 1e-13);
}

// A crank's given velocity is a little off the circle once its pin has moved; the heavy rest must
// not slow it down, however much lighter the pin is.
TEST(AssembleStart, GivenVelocitiesChangeLast) {
  SceneData data = Frame{
      {{"O", 0, 0, false}, {"E", 0.71, 0.7, true}, {"P", 2, 0, true, 100.0}},
      {{0, 1, 1.0},
       {1, 2, 1.5}}}.build(0.1);
  data.model.initial_velocity = {-0.7, 0.7, 0.0, 0.0};
  assemble_start(data, "test");
  EXPECT_LT(rate_violation(data), 1e-14);
  const double speed = std::hypot(data.model.initial_velocity[0], data.model.initial_velocity[1]);
  EXPECT_NEAR(speed, 0.7 * std::sqrt(2.0), 1e-3);
  EXPECT_GT(std::abs(data.model.initial_velocity[2]), 0.1);
}

TEST(AssembleStart, RefusesADriverThatTheStartCannotFollow) {
  // Stretched along x, pulled further along x.
  SceneData data = Frame{
      {{"A", 0, 0, false}, {"B", 1, 0, true}, {"C", 2, 0, false}},
      {{0, 1, 1.0},
       {1, 2, 1.0}}}.build(0.1);
  data.model.driven_points.push_back({2, {ramp(1.0, 2.0), 0.0, 0.0}});
  const std::string message = refusal(data);
  EXPECT_NE(message.find("cannot be made consistent"), std::string::npos) << message;
}

TEST(AssembleStart, WithoutConstraintsNothingMoves) {
  SceneData data = Frame{{{"B", 1, 2, true}}, {}}.build(0.0);
  data.model.initial_velocity = {3.0, 4.0};
  assemble_start(data, "test");
  EXPECT_EQ(data.model.initial_velocity, (std::vector<double>{3.0, 4.0}));
}

TEST(AssembleStart, AssemblesLongChains) {
  SceneData data;
  data.model = four_bar(9'999);  // 20 000 coordinates
  for (std::size_t i = 10'000; i < 20'000; ++i) {
    data.model.points[i].position[0] += 1e-3 * std::sin(static_cast<double>(i));
    data.model.points[i].position[1] += 1e-3 * std::cos(3.0 * static_cast<double>(i));
  }
  data.largest_correction = 0.1;
  assemble_start(data, "test");
  EXPECT_LT(violation(data), 1e-14);
  EXPECT_LT(rate_violation(data), 1e-12);
  EXPECT_LT(data.assembly.position_correction, 0.02);
}

}  // namespace
}  // namespace mbs
