// The library: inputs mean the same as functions of time in every implementation, states come back,
// nothing allocates.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <mbs/stepper.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "registry/registry.hpp"
#include "scene/time_functions.hpp"
#include "support/allocation_counter.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

const std::map<std::string, Sine>& sines() {
  static const std::map<std::string, Sine> all{
      {"point", {0.05, 1.0, 0.3, 0.0}},  {"constraint", {0.1, 0.7, 0.0, 1.0}},
      {"force", {3.0, 2.0, 0.2, 1.0}},   {"load", {2.0, 1.5, 0.0, 0.0}},
      {"torque", {0.5, 1.0, 1.0, 0.2}},  {"stiffness", {20.0, 3.0, 0.0, 60.0}},
      {"damping", {0.5, 2.0, 0.0, 1.0}}, {"factor", {0.3, 1.0, 0.0, 1.0}}};
  return all;
}

/// A function of this name, as the sine or as an input that starts where the sine does.
std::string function(const std::string& name, bool is_input) {
  const Sine& s = sines().at(name);
  nlohmann::json result = {{"sine",
                            {{"amplitude", s.amplitude},
                             {"frequency", s.frequency},
                             {"phase", s.phase},
                             {"offset", s.offset}}}};
  if (is_input) result = {{"input", {{"name", name}, {"value", sine(s).at(0.0).value}}}};
  return result.dump();
}

/// Everything in the plane that may be a function of time; `of` writes one.
std::string planar_text(const std::function<std::string(const char*)>& of) {
  return R"({"points": [{"name": "O", "position": [0, 0], "fixed": true},
      {"name": "D", "position": [2, 0], "driven": {"y": )" +
         of("point") + R"(}}, {"name": "P", "position": [0, 1]},
      {"name": "A", "position": [1, 0]}, {"name": "B", "position": [2, -1]}, {"name": "C", "position": [3, 0.5]}],
    "rods": [{"name": "rod", "between": ["O", "A"], "mass": 2}, {"between": ["A", "B"], "mass": 1}],
    "bodies": [{"name": "plate", "mass": 2, "inertia": 0.5, "centre": [0.2, 0.1],
                "points": {"B": [0, 0], "C": [1, 1.5], "E": [0.4, -0.3]}}],
    "masses": [{"point": "P", "mass": 1}],
    "constraints": [{"type": "distance", "between": ["O", "P"], "value": )" +
         of("constraint") + R"(}],
    "springs": [{"between": ["D", "B"], "stiffness": )" +
         of("stiffness") + R"(, "damping": )" + of("damping") + R"(},
                {"between": ["P", "A"], "stiffness": 30, "damping": )" +
         of("damping") + R"(, "length": 1}],
    "force_laws": [{"between": ["P", "C"], "by_length": {"lengths": [0, 3], "forces": [-20, 10]},
                    "factor": )" +
         of("factor") + R"(}],
    "forces": [{"point": "B", "force": [)" +
         of("force") + R"(, 2]}, {"point": "E", "force": [-1, )" + of("load") + R"(]}],
    "torques": [{"direction": ["O", "A"], "torque": )" +
         of("torque") + R"(}],
    "outputs": [{"name": "end", "position": "E"}, {"name": "turn", "angle": [["O", "D"], ["O", "A"]]}]})";
}

std::string spatial_text(const std::function<std::string(const char*)>& of) {
  return R"({"dimension": 3,
    "points": [{"name": "O", "position": [0, 0, 0], "fixed": true}, {"name": "A", "position": [1, 0, 0.2]},
      {"name": "D", "position": [1, 1, 0], "driven": {"z": )" +
         of("point") + R"(}}],
    "rods": [{"between": ["O", "A"], "mass": 1}],
    "bodies": [{"name": "top", "mass": 2, "inertia": [0.3, 0.4, 0.5], "pose": {"position": [1, 0, 0.2]},
                "points": {"A": [0, 0, 0], "E": [0.3, 0.4, 0.5]}}],
    "springs": [{"between": ["D", "A"], "stiffness": )" +
         of("stiffness") + R"(, "damping": )" + of("damping") + R"(}],
    "forces": [{"point": "E", "force": [)" +
         of("force") + ", " + of("load") + R"(, 1]}],
    "outputs": [{"name": "end", "position": "E"}]})";
}

std::string hinge(
    const std::function<std::string(const char*)>& of) {  // a torque about a fixed axis in space
  return R"({"dimension": 3, "vectors": [{"name": "z", "direction": [0, 0, 1], "fixed": true}],
    "bodies": [{"name": "door", "mass": 2, "inertia": [0.3, 0.4, 0.5], "centre": [0.5, 0, 0], "pose": {"position": [0, 0, 0]},
                "points": {"O": [0, 0, 0], "E": [1, 0, 0]}, "vectors": {"z": [0, 0, 1]}}],
    "points": [{"name": "O", "position": [0, 0, 0], "fixed": true}],
    "torques": [{"direction": ["O", "E"], "axis": "z", "torque": )" +
         of("torque") + R"(}],
    "outputs": [{"name": "end", "position": "E"}]})";
}

using SceneText = std::string (*)(const std::function<std::string(const char*)>&);

/// Names of the implementations of this build that serve the scene.
std::vector<std::string> serving(const SceneDocument& scene) {
  std::vector<std::string> names;
  for (const Offer& one : implementations()) {
    try {
      const Stepper stepper(scene, {.implementation = one.name});
      names.push_back(one.name);
    } catch (const Unsupported&) {
    }
  }
  return names;
}

class StepperInputs : public testing::TestWithParam<SceneText> {};

TEST_P(StepperInputs, AreWhatFunctionsOfTimeAreInEveryImplementation) {
  const auto scene = [](bool is_input) {
    return SceneDocument::parse(
        GetParam()([is_input](const char* name) { return function(name, is_input); }));
  };
  const SceneDocument known = scene(false), set = scene(true);
  const auto names = serving(known);
  EXPECT_EQ(names, serving(set));
  ASSERT_GE(names.size(), 8u);
  for (const std::string& name : names) {
    Stepper with_functions(known, {.implementation = name});
    Stepper with_inputs(set, {.implementation = name, .settings = with_functions.settings()});
    Saved start, other;
    with_functions.save(start);  // whose accelerations are those of moving drivers
    with_inputs.save(other);
    other.state = start.state;
    with_inputs.restore(other);
    for (int step = 1; step <= 40; ++step) {
      const double t = step * with_inputs.settings().step;
      for (const std::string& input : with_inputs.input_names()) {
        const TimeFunction::Sample now = sine(sines().at(input)).at(t);
        with_inputs.set_input(with_inputs.input(input), now.value, now.rate, now.acceleration);
      }
      ASSERT_EQ(with_functions.step().status, StepStatus::converged) << name;
      ASSERT_EQ(with_inputs.step().status, StepStatus::converged) << name;
    }
    const State &a = with_functions.state(), &b = with_inputs.state();
    for (std::size_t i = 0; i < a.q.size(); ++i) {
      EXPECT_NEAR(a.q[i], b.q[i], 1e-12) << name;
      EXPECT_NEAR(a.v[i], b.v[i], 1e-10) << name;
    }
    EXPECT_NEAR(with_functions.outputs()[0], with_inputs.outputs()[0], 1e-12) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, StepperInputs, testing::Values(planar_text, spatial_text, hinge));

/// Inputs that stay are the numbers of a scene that has no function of time: springs, couples,
/// constant forces.
TEST_P(StepperInputs, ThatStayAreNumbers) {
  const auto value = [](const char* name) { return std::string(name) == "point" ? 0.0 : 1.0; };
  const auto number = [&](const char* name) { return nlohmann::json(value(name)).dump(); };
  const auto input = [&](const char* name) {
    return nlohmann::json{{"input", {{"name", name}, {"value", value(name)}}}}.dump();
  };
  const SceneDocument numbers = SceneDocument::parse(GetParam()(number)),
                      inputs = SceneDocument::parse(GetParam()(input));
  for (const std::string& name : serving(inputs)) {
    Stepper a(numbers, {.implementation = name});
    Stepper b(inputs, {.implementation = name, .settings = a.settings()});
    ASSERT_EQ(a.step(100).status, StepStatus::converged) << name;
    ASSERT_EQ(b.step(100).status, StepStatus::converged) << name;
    for (std::size_t i = 0; i < a.outputs().size(); ++i)
      EXPECT_NEAR(a.outputs()[i], b.outputs()[i], 1e-9) << name;
  }
}

SceneDocument planar_with_inputs() {
  return SceneDocument::parse(planar_text([](const char* name) { return function(name, true); }));
}

TEST(Stepper, ComesBackToWhatItSaved) {
  const SceneDocument scene = planar_with_inputs();
  for (const std::string& name : serving(scene)) {
    Stepper stepper(scene, {.implementation = name});
    const int force = stepper.input("force"), turn = stepper.output("turn");
    stepper.set_input(force, 5.0);
    ASSERT_EQ(stepper.step(20).status, StepStatus::converged) << name;
    Saved moment;
    static_cast<void>(stepper.outputs());
    stepper.save(moment);
    const auto go_on = [&] {
      EXPECT_EQ(stepper.step(20).status, StepStatus::converged) << name;
      return stepper.outputs()[static_cast<std::size_t>(turn)];
    };
    const double first = go_on();
    stepper.restore(moment);
    stepper.set_input(force, -50.0);
    EXPECT_GT(std::abs(go_on() - first), 1e-4) << name;  // what if
    stepper.restore(moment);
    EXPECT_NEAR(go_on(), first, 1e-12) << name;
  }
}

TEST(Stepper, AllocatesNothingOnceItRuns) {
  if (!test::counts_allocations())
    GTEST_SKIP() << "sanitizers bring their own malloc: nothing can be counted";
  Stepper stepper(planar_with_inputs());
  Saved moment;
  const auto loop = [&] {
    for (int step = 0; step < 20; ++step) {
      stepper.set_input(0, 0.1);
      static_cast<void>(stepper.step());
      static_cast<void>(stepper.outputs());
    }
    stepper.save(moment);
    stepper.restore(moment);
  };
  loop();
  const long before = test::allocations();
  loop();
  EXPECT_EQ(test::allocations(), before);
}

TEST(Stepper, TakesTheRulesChoiceAndItsNumbers) {
  Stepper stepper(SceneDocument::load("vehicle:4"), {.settings = {.step = 1e-3}});
  EXPECT_NE(stepper.implementation(), "");
  EXPECT_GT(stepper.settings().penalty, 1.0);
  EXPECT_GT(stepper.settings().tolerance, 0.0);
  EXPECT_EQ(stepper.step(10).status, StepStatus::converged);
  EXPECT_NEAR(stepper.state().t, 1e-2, 1e-15);
}

/// A rod that turns at 20 rad/s, from 0.01 rad short of half a turn: so often in half a second that
/// no angle alone tells it.
SceneDocument spinning() {
  return SceneDocument::parse(R"({"gravity": [0, 0], "points": [
      {"name": "O", "position": [0, 0], "fixed": true}, {"name": "X", "position": [1, 0], "fixed": true},
      {"name": "B", "position": [-0.99995, 0.0099998], "velocity": [-0.2, -20]}],
    "rods": [{"between": ["O", "B"], "mass": 1}],
    "outputs": [{"name": "phi", "angle": [["O", "X"], ["O", "B"]]}]})");
}

TEST(Stepper, CountsTurnsWhoeverAsks) {
  const StepperOptions options{.settings = {.step = 1e-3}};
  Stepper stepper(spinning(), options), alone(spinning(), options);
  BatchStepper batch(std::vector(2, spinning()), options);
  for (int half = 1; half <= 4; ++half) {
    ASSERT_EQ(stepper.step(500).status, StepStatus::converged);
    for (int i = 0; i < 500; ++i) {
      static_cast<void>(alone.step());
      static_cast<void>(batch.step());
    }
    const double turned = std::numbers::pi - 0.01 + 10.0 * half;
    EXPECT_NEAR(stepper.outputs()[0], turned, 0.01);
    EXPECT_NEAR(alone.outputs()[0], turned, 0.01);
    for (int lane = 0; lane < 2; ++lane) EXPECT_NEAR(batch.outputs(lane)[0], turned, 0.01);
  }
}

/// The one line of what `work` refuses.
std::string refused_by(const std::function<void()>& work) {
  try {
    work();
  } catch (const Refused& error) {
    return error.what();
  } catch (const Unsupported& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Stepper, RefusesInOneLine) {
  const SceneDocument scene = planar_with_inputs();
  EXPECT_NE(refused_by([] {
              static_cast<void>(SceneDocument::load("nowhere.json"));
            }).find("no such file"),
            std::string::npos);
  EXPECT_NE(refused_by([&] {
              Stepper(scene, {.implementation = "nobody"});
            }).find("unknown implementation"),
            std::string::npos);
  EXPECT_NE(refused_by([&] {
              static_cast<void>(Stepper(scene).input("wind"));
            }).find("has no input 'wind': there are "),
            std::string::npos);
  expect_parts(refused_by([&] { static_cast<void>(scene.number("springs/9/stiffness")); }),
               {"\"springs/9/stiffness\": found no \"9\" in springs"});
  StepperOptions options;
  options.settings.step = -1.0;
  expect_parts(refused_by([&] { Stepper(scene, options); }), {"step", "-1"});
  options.settings.step = 1e-3;
  options.settings.scheme = Scheme::rattle;
  expect_parts(refused_by([&] { Stepper(scene, options); }),
               {"scheme rattle is for scenes without drivers"});
  expect_parts(refused_by([&] { Stepper(SceneDocument::load("four-bar:3"), options); }),
               {"scheme rattle", "name an implementation"});
}

TEST(Stepper, RefusesSettingsByTheirOwnNames) {
  const SceneDocument scene = SceneDocument::load("four-bar:3");
  StepperOptions options{.implementation = "csc_ldl/uplooking"};
  const auto said = [&] { return refused_by([&] { Stepper(scene, options); }); };
  options.settings.max_passes = 0;
  EXPECT_EQ(said().find("max_passes is 0"), 0u) << said();
  options.settings = {.step = 1e-200};  // the penalty factor would be infinite
  EXPECT_EQ(said().find("step is 1e-200 s: it must be"), 0u) << said();
  options.settings = {.projections_every = 0};
  EXPECT_EQ(said().find("projections_every is 0"), 0u) << said();
  options.settings = {.scheme = Scheme::multistep6};
  EXPECT_EQ(said().find("csc_ldl/uplooking: it does not offer scheme multistep6"), 0u) << said();
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Stepper, RefusesInputsThatAFileMayNotHave) {
  Stepper stepper(planar_with_inputs());
  const auto said = [&](const char* name, const TimeFunction::Sample& to) {
    return refused_by(
        [&] { stepper.set_input(stepper.input(name), to.value, to.rate, to.acceleration); });
  };
  Saved before, after;
  stepper.save(before);
  expect_parts(said("force", {kNan}), {"input 'force': found the value nan, allowed is"});
  expect_parts(said("force", {1e60}), {"input 'force': found the value 1e+60, allowed is"});
  expect_parts(said("point", {0.0, -kInfinity}), {"input 'point': found the rate -inf"});
  expect_parts(said("point", {0.0, 0.0, kNan}), {"input 'point': found the acceleration nan"});
  expect_parts(said("stiffness", {-1.0}),
               {"found the value -1", "a stiffness in N/m of at least 0"});
  expect_parts(said("constraint", {0.0}), {"found the value 0", "a distance in m above 0"});
  expect_parts(refused_by([&] { stepper.set_input(8, 0.0); }),
               {"no input 8", "force, ", "stiffness"});
  expect_parts(refused_by([&] { stepper.set_input(-1, 0.0); }), {"no input -1"});
  expect_parts(refused_by([&] { static_cast<void>(stepper.step(0)); }), {"0 steps", "1 or more"});
  stepper.save(after);
  for (std::size_t i = 0; i < before.inputs.size(); ++i) {
    EXPECT_EQ(after.inputs[i].value, before.inputs[i].value);
    EXPECT_EQ(after.inputs[i].rate, before.inputs[i].rate);
  }
  EXPECT_EQ(after.state.t, 0.0);
  stepper.set_input(stepper.input("force"), -1.0);  // which may have any sign
}

TEST(Stepper, RestoresOnlyWhatItCouldHaveSaved) {
  Stepper stepper(planar_with_inputs());
  ASSERT_EQ(stepper.step(10).status, StepStatus::converged);
  Saved saved;
  stepper.save(saved);
  const std::vector<double> q = stepper.state().q;
  const auto said = [&](const std::function<void(Saved&)>& spoil) {
    Saved other = saved;
    spoil(other);
    return refused_by([&] { stepper.restore(other); });
  };
  const auto stiffness = static_cast<std::size_t>(stepper.input("stiffness"));
  expect_parts(said([&](Saved& it) { it.inputs[stiffness].value = -5; }), {"'stiffness'", "-5"});
  expect_parts(said([](Saved& it) { it.inputs[0].value = kNan; }), {"the value nan"});
  expect_parts(said([](Saved& it) { it.state.q[0] = kNan; }), {"state.q[0] is not finite"});
  expect_parts(said([](Saved& it) { it.angles[1] = kNan; }), {"angles[1] is nan"});
  expect_parts(said([](Saved& it) { it = {}; }), {"another scene"});
  EXPECT_EQ(stepper.state().q, q);
  EXPECT_EQ(said([](Saved& /*it*/) {}), "not refused");

  const auto pendulum_of = [](double length) {
    return SceneDocument::parse(pendulum("-2", std::to_string(-length)));
  };
  Stepper one(pendulum_of(1.0)), same(pendulum_of(1.0)), other(pendulum_of(5.0)),
      finer(pendulum_of(1.0), {.settings = {.step = 1e-3}});
  one.save(saved);
  same.restore(saved);
  expect_parts(refused_by([&] { other.restore(saved); }), {"another scene or other settings"});
  expect_parts(refused_by([&] { finer.restore(saved); }), {"another scene or other settings"});
}

TEST(Implementations, SayWhetherTheyAllocate) {
  int allocating = 0;
  for (const Offer& one : implementations()) {
    const NamedVariant found = select_variants({one.name}).front();
    EXPECT_EQ(one.allocates, found.variant->allocates) << one.name;
    allocating += !one.allocates.empty();
  }
  EXPECT_GT(allocating, 0);
}

TEST(SceneDocument, ChangesNumbersOfACopyAlone) {
  const SceneDocument one = SceneDocument::load("vehicle:4");
  SceneDocument other = one;
  const std::string path = "springs/0/damping";
  other.set_number(path, 2 * one.number(path) + 1);
  EXPECT_NE(other.number(path), one.number(path));
  EXPECT_NE(one.describe().find("recommendation"), std::string::npos);
}

TEST(SceneDocument, ANumberMayTakeThePlaceOfAnExpression) {
  SceneDocument scene = SceneDocument::parse(
      pendulum(R"("mass": 3)", R"("mass": "=2*m")").replace(0, 1, R"({"parameters": {"m": 1}, )"));
  EXPECT_EQ(refused_by([&] { Stepper{scene}; }), "not refused");
  scene.set_number("rods/rod/mass", 4.0);  // nothing names m now
  EXPECT_EQ(refused_by([&] { Stepper{scene}; }), "not refused");
  EXPECT_EQ(scene.number("m"), 1.0);
}

TEST(SceneDocument, RefusesWhatIsNoSceneOrNumber) {
  expect_parts(refused_by([] { SceneDocument::parse("[]", "mine"); }),
               {"mine: found array, allowed is an object"});
  SceneDocument scene = planar_with_inputs();
  expect_parts(refused_by([&] { scene.set_number("rods/rod/mass", kNan); }),
               {"rods/rod/mass: found nan, allowed is a finite number"});
  EXPECT_EQ(scene.number("rods/rod/mass"), 2.0);
  scene.set_number("springs/0/stiffness/input/value", -1.0);
  expect_parts(refused_by([&] { Stepper{scene}; }),
               {"springs[0].stiffness: found a value of", "-1 at t = 0 s", "at least 0"});
}

TEST(BatchStepper, RefusesOtherLanes) {
  const std::vector<SceneDocument> scenes(2, planar_with_inputs());
  BatchStepper batch(scenes);
  const int force = batch.input("force");
  expect_parts(refused_by([&] { batch.set_input(2, force, 0.0); }),
               {"found lane 2, allowed is 0 to 1"});
  expect_parts(refused_by([&] { static_cast<void>(batch.outputs(-1)); }), {"found lane -1"});
  expect_parts(refused_by([&] { static_cast<void>(batch.settings(9)); }), {"found lane 9"});
  expect_parts(refused_by([&] { batch.set_input(1, force, kNan); }), {"'force'", "nan"});
  expect_parts(refused_by([&] { static_cast<void>(batch.output("nothing")); }), {"end.x", "turn"});
}

TEST(BatchStepper, MovesEachLaneAsAStepperDoes) {
  const auto of =
      [](const std::string& name) {  // laws of forces would leave nobody who offers batches
        return name == "stiffness" || name == "damping" ? std::string("20") : function(name, true);
      };
  std::vector<SceneDocument> scenes;
  for (int i = 0; i < 3; ++i) {
    scenes.push_back(SceneDocument::parse(spatial_text(of)));
    scenes.back().set_number("rods/O-A/mass", 1.0 + 0.1 * i);
  }
  int batches = 0;
  for (const std::string& name : serving(scenes.front())) {
    BatchStepper batch(scenes, {.implementation = name});
    batches += batch.is_side_by_side();
    for (int lane = 0; lane < 3; ++lane) batch.set_input(lane, 0, 0.0, 0.0, 0.1 * lane);
    for (int step = 0; step < 50; ++step) {
      for (const StepOutcome& outcome : batch.step())
        EXPECT_EQ(outcome.status, StepStatus::converged) << name;
    }
    for (int lane = 0; lane < 3; ++lane) {
      Stepper alone(scenes[static_cast<std::size_t>(lane)],
                    {.implementation = name, .settings = batch.settings(lane)});
      alone.set_input(0, 0.0, 0.0, 0.1 * lane);
      ASSERT_EQ(alone.step(50).status, StepStatus::converged);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(batch.outputs(lane)[i], alone.outputs()[i], 1e-9) << name;
    }
  }
  EXPECT_GT(batches, 0);
}

TEST(SceneFile, RefusesAnInputOfTwoStarts) {
  const std::string message =
      parse_error_of(R"({"points": [{"name": "A", "position": [0, 0], "driven":
    {"x": {"input": {"name": "u", "value": 1}}, "y": {"input": {"name": "u"}}}}, {"name": "B", "position": [1, 0]}],
    "rods": [{"between": ["A", "B"], "mass": 1}]})");
  EXPECT_NE(message.find("starts elsewhere"), std::string::npos) << message;
}

TEST(SceneFile, RefusesAFunctionOfTimeAboutAMovingAxis) {
  const std::string message = parse_error_of(
      R"({"dimension": 3, "points": [{"name": "O", "position": [0, 0, 0], "fixed": true}],
    "bodies": [{"name": "b", "mass": 1, "inertia": [1, 1, 1], "points": {"O": [0, 0, 0]}, "vectors": {"z": [0, 0, 1]},
                "pose": {"position": [0, 0, 0]}}],
    "torques": [{"body": "b", "axis": "z", "torque": {"input": {"name": "u"}}}]})");
  EXPECT_NE(message.find("an axis that moves"), std::string::npos) << message;
}

}  // namespace
}  // namespace mbs
