// A platform on many legs of two links, each leg hinged to the ground and held by a spring.
#include <cmath>
#include <numbers>

#include "printable.hpp"
#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"
#include "usage_error.hpp"

namespace mbs {

SceneSize robot_size(const FamilyValues& values) {
  const long legs = values[0];
  return {6 * legs + 3, 6 * legs - 3};
}

/// A leg goes from its hinge B_i out to the knee K_i, which stays in the plane through the vertical
/// axis, and back to P_i of the platform, to the left and right by turns, as in a Stewart platform.
/// A spring from the post A_i pulls the knee in with the force that carries the leg's share of the
/// weight. So it would stand; it starts with a blow to the platform.
nlohmann::json robot_document(const FamilyValues& values) {
  constexpr double kFoot = 1.0, kPlatform = 0.7, kHeight = 0.9;  // m: radii, height of the joints
  constexpr double kLower = 0.5, kKneeAngle = 1.1;               // m; rad from the ground
  constexpr double kShare = 20.0, kLowerMass = 2.0, kUpperMass = 1.0;  // kg; of the platform a leg
  constexpr double kTwist = 0.5;     // rad about the vertical, by which upper links lean
  constexpr double kStretch = 0.02;  // m, of a spring that carries its share
  const int legs = values[0];
  if (legs % 2 != 0) {
    throw UsageError(fmt::format("robot: found N = {}, allowed is an even number of legs", legs));
  }
  const Vector3 velocity{0.05, -0.1, 0.02}, spin{0.1, 0.05, -0.05};  // of the platform; m/s, rad/s
  SceneWriter scene(3);
  const Vector3 centre{0.0, kHeight, 0.0};
  const double mass = kShare * legs, across = kPlatform * kPlatform / 4.0;  // kg, m^2
  nlohmann::json platform{
      {"name", "platform"},
      {"mass", mass},
      {"inertia", {mass * (across + 0.01), 2.0 * mass * across, mass * (across + 0.01)}},
      {"pose", {{"position", scene.vector(centre)}}},
      {"velocity", scene.vector(velocity)},
      {"angular_velocity", scene.vector(spin)}};
  for (int i = 0; i < legs; ++i) {
    const double step = 2.0 * std::numbers::pi / legs, at = i * step;
    const double top = at + (i % 2 == 0 ? kTwist : -kTwist);
    const Vector3 out{std::cos(at), 0.0, std::sin(at)}, side{-std::sin(at), 0.0, std::cos(at)};
    const Vector3 up{0.0, 1.0, 0.0};
    const Vector3 foot = kFoot * out, post = 0.5 * kFoot * out + 0.5 * up;
    const Vector3 arm = kLower * (std::cos(kKneeAngle) * out + std::sin(kKneeAngle) * up);
    const Vector3 knee = foot + arm;
    const Vector3 local = kPlatform * Vector3{std::cos(top), 0.0, std::sin(top)};
    const Vector3 joint = centre + local;
    const std::string A = numbered("A", i), B = numbered("B", i), K = numbered("K", i),
                      P = numbered("P", i);
    // The knee turns about `side`, which the upper link asks for with the platform's velocity.
    const Vector3 upper = joint - knee, turning = cross(side, arm);
    const double rate = dot(velocity + cross(spin, local), upper) / dot(turning, upper);
    scene.fixed(A, post);
    scene.fixed(B, foot);
    scene.point(K, knee, rate * turning);
    scene.point(P, joint);
    platform["points"][P] = scene.vector(local);
    scene.rod(B, K, kLowerMass);
    scene.rod(K, P, kUpperMass);
    nlohmann::json terms = nlohmann::json::array();
    for (const auto& [axis, k] : {std::pair("x", side[0]), std::pair("z", side[2])}) {
      if (std::abs(k) < 1e-12) continue;
      terms.push_back({{"point", K}, {"axis", axis}, {"coefficient", k}});
    }
    scene.add(
        "constraints",
        {{"name", numbered("hinge", i)}, {"type", "linear"}, {"terms", terms}, {"value", 0.0}});
    // Virtual work of a turn of the knee: the upper link pushes with `thrust` times its vector.
    const double thrust = (kShare + kUpperMass / 2.0) * 9.81 / upper[1];  // N/m
    const double weight = (kLowerMass + kUpperMass) / 2.0 * 9.81;         // N, at the knee
    const Vector3 pull = (1.0 / norm(post - knee)) * (post - knee);
    const double force =
        (thrust * dot(upper, turning) + weight * turning[1]) / dot(pull, turning);  // N
    scene.spring(A, K, force / kStretch, norm(post - knee) - kStretch);
  }
  scene.add("bodies", platform);
  scene.position_output("P0");
  return std::move(scene).finish();
}

}  // namespace mbs
