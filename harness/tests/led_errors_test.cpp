// Local errors where drivers lead points about: across the way that they are led.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "controls/controls.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

RunSummary run_of(const std::string& text, double duration, StepSettings step) {
  const Scene scene = scene_of(nlohmann::json::parse(text), "test");
  RunSettings settings;
  settings.step = chosen(scene.model, step);
  settings.duration = duration;
  return run(scene, test::reference(), settings);
}

// A body on a spring, which bounces 0.1 m at 1.5 Hz while its car brakes from 40 m/s.
constexpr const char* kBraking = R"({
    "points": [{"name": "road", "position": [0, 0], "driven": {"x": {"polynomial": [0, 40, -1]}}},
               {"name": "body", "position": [0, 0.6], "velocity": [40, 0]}],
    "masses": [{"point": "body", "mass": 300}],
    "springs": [{"between": ["road", "body"], "stiffness": 26647.93, "length": 0.61044}],
    "constraints": [{"name": "ahead", "type": "linear", "value": {"polynomial": [0, 40, -1]},
                     "terms": [{"point": "body", "axis": "x", "coefficient": 1}]}]})";

/// A pendulum whose foot goes up and down at about twice its own frequency, m, Hz.
std::string shaken(double amplitude, double frequency) {
  return fmt::format(R"({{
    "points": [{{"name": "A", "position": [0, 0],
                 "driven": {{"y": {{"sine": {{"amplitude": {0}, "frequency": {1}}}}}}}}},
               {{"name": "P", "position": [0.002, -1], "velocity": [0, "=2*pi*{0}*{1}"]}}],
    "rods": [{{"name": "rod", "between": ["A", "P"], "mass": 0, "length": 1}}],
    "masses": [{{"point": "P", "mass": 1}}]}})",
                     amplitude, frequency);
}

TEST(LedErrors, AcrossTheWayCount) {
  // The lag is w t (w dt)^2/12 of 0.1 m: 2.8 cm at the end, almost all of it across the way.
  EXPECT_EQ(run_of(kBraking, 19.0, {.step = 0.0104}).status, RunStatus::degraded);
  const RunSummary sound = run_of(kBraking, 19.0, {.step = 2e-3});
  EXPECT_EQ(sound.status, RunStatus::plausible) << sound.reason;
}

TEST(LedErrors, WhatADriverDoesIsNone) {
  // Off by a tenth of a millimetre. What the rule would leave of the foot's motion is more.
  const RunSummary sound = run_of(shaken(0.03, 0.98), 40.0, {.step = 0.0189});
  EXPECT_EQ(sound.status, RunStatus::plausible) << sound.reason;
}

TEST(LedErrors, OfKeptTangentsCountAcrossTheWay) {
  // It swings out by more than half a metre; off by 7 cm at the end.
  const StepSettings kept{.step = 1 / (1.06 * 512), .tangent = TangentReuse::kept};
  EXPECT_EQ(run_of(shaken(0.08, 1.06), 40.0, kept).status, RunStatus::degraded);
}

}  // namespace
}  // namespace mbs
