// A scissor arm: pairs of crossing bars, pinned at their middles and
// ends.
#include <cmath>

#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"

namespace mbs {

SceneSize scissors_size(const FamilyValues& values) {
  const long stages = values[0];
  return {6 * stages - 2, 6 * stages - 3};
}

/// Lies flat. Bars go from L_i to R_(i+1) and from R_i to L_(i+1) and share the pin C_i at their
/// middles. L0 is fixed, R0 slides on the wall y = 0. Springs from L_i to R_i hold it where it is;
/// it starts with a blow that opens it, to the end as fast whatever N is.
nlohmann::json scissors_document(const FamilyValues& values) {
  constexpr double kBar = 1.0, kBarMass = 2.0, kPayload = 10.0;  // m, kg, kg
  constexpr double kAngle = 0.8, kBlow = 0.3, kSpring = 200.0;   // rad; over N, rad/s; N/m
  const int stages = values[0];
  SceneWriter scene;
  scene.gravity({});
  const double width = kBar * std::cos(kAngle), rise = kBar * std::sin(kAngle);
  const double rate = kBlow / stages;
  const auto add_point = [&](const std::string& name, double widths, double rises) {
    scene.point(name, {widths * width, rises * rise, 0.0},
                {-widths * rise * rate, rises * width * rate, 0.0});
  };
  scene.fixed("L0", {});
  add_point("R0", 1.0, 0.0);
  for (int i = 1; i <= stages; ++i) {
    add_point(numbered("L", i), 0.0, i);
    add_point(numbered("R", i), 1.0, i);
    add_point(numbered("C", i - 1), 0.5, i - 0.5);
  }
  const auto add_bar = [&](const std::string& from, const std::string& pin, const std::string& to) {
    nlohmann::json bar{{"name", from + "-" + to},
                       {"mass", kBarMass},
                       {"inertia", kBarMass * kBar * kBar / 12.0},
                       {"centre", {kBar / 2.0, 0.0}}};
    bar["points"] = {{from, {0.0, 0.0}}, {pin, {kBar / 2.0, 0.0}}, {to, {kBar, 0.0}}};
    scene.add("bodies", bar);
  };
  for (int i = 0; i < stages; ++i) {
    const std::string pin = numbered("C", i);
    add_bar(numbered("L", i), pin, numbered("R", i + 1));
    add_bar(numbered("R", i), pin, numbered("L", i + 1));
    scene.spring(numbered("L", i), numbered("R", i), kSpring, width);
  }
  const nlohmann::json term{{"point", "R0"}, {"axis", "y"}, {"coefficient", 1.0}};
  scene.add("constraints", {{"name", "wall"},
                            {"type", "linear"},
                            {"terms", nlohmann::json::array({term})},
                            {"value", 0.0}});
  for (const char* side : {"L", "R"}) scene.mass(numbered(side, stages), kPayload / 2.0);
  scene.position_output(numbered("R", stages));
  return std::move(scene).finish();
}

}  // namespace mbs
