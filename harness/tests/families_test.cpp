// Families of mechanisms: their names, their sizes, and the physics of each against a closed form.
#include "scene/families/families.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "controls/controls.hpp"
#include "model_math/kinematics.hpp"
#include "model_math/vector3.hpp"
#include "run/initial_state.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene/families/beam_mass.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

constexpr double kG = 9.81;

const Point& point_named(const Scene& scene, const std::string& name) {
  for (const Point& point : scene.model.points()) {
    if (point.name == name) return point;
  }
  throw std::runtime_error("no point " + name);
}

/// What `of` is of a point of the scene, or of a body's point that is a sum of others.
template <class Of>
Vector3 of_named(const Scene& scene, const std::string& name, Of of) {
  for (const Marker& marker : scene.elements.markers) {
    if (marker.name != name) continue;
    Vector3 sum{};
    for (const Marker::Part& one : marker.parts) {
      const Point& point = scene.model.points()[static_cast<std::size_t>(one.point)];
      sum = sum + multiply(one.matrix, of(point));
    }
    return sum;
  }
  return of(point_named(scene, name));
}
Vector3 part(const Scene& scene, const std::string& name, const std::vector<double>& x) {
  return of_named(scene, name, [&](const Point& point) {
    Vector3 result{};
    if (!point.is_fixed()) {
      std::copy_n(x.begin() + point.offset, scene.model.dimension(), result.begin());
    }
    return result;
  });
}
Vector3 place(const Scene& scene, const std::string& name) {
  return of_named(scene, name, [](const Point& point) { return point.position; });
}

/// The accelerations with which a scene begins, Eq. (1) with Phi'' = 0.
class Start {
 public:
  explicit Start(const std::string& name) : Start(load_scene(name)) {}
  explicit Start(Scene begun) : scene(std::move(begun)), state(initial_state(scene.model)) {}

  [[nodiscard]] Vector3 acceleration(const std::string& point) const {
    return part(scene, point, state.a);
  }
  void expect(const std::string& point, const Vector3& acceleration) const {
    const Vector3 off = this->acceleration(point) - acceleration;
    EXPECT_LT(norm(off), 1e-8 * (1.0 + norm(acceleration)))
        << point << ": " << this->acceleration(point)[0] << ", " << this->acceleration(point)[1];
  }
  /// That of a body turning about the origin from rest at `angular` rad/s^2.
  void expect_turning(const std::string& point, double angular) const {
    expect(point, cross({0.0, 0.0, angular}, place(scene, point)));
  }

  Scene scene;
  State state;
};

/// Angular acceleration of a pendulum of one rod, or of what is in closed form the same.
double swinging(double lean, double moment, double inertia) {
  return -kG * moment * std::sin(lean) / inertia;
}

/// One of two bodies alike, as the first of them begins: hinged at the origin.
struct Limb {
  double mass = 0.0;     // kg
  Vector3 centre{};      // of its mass, m
  double inertia = 0.0;  // about the origin, kg m^2
  Vector3 hinge{};       // to the other, m
};

/// Points of the first and of the second of two limbs that begin as one body turning at w. With A
/// and B the two angular accelerations, the hinge h has A x h - w^2 h; to that the second's centre,
/// c from there, adds B x c - w^2 c. So the moments about both hinges are, with I of a limb:
///   (I + m h.h) A + m h.c B = -m g (c_x + h_x) + m w^2 (h x c)
///         m h.c A +     I B = -m g c_x         - m w^2 (h x c)
void expect_double_pendulum(nlohmann::json document, const Limb& limb,
                            const std::vector<std::string>& first,
                            const std::vector<std::string>& second) {
  constexpr double kRate = 2.0;  // w, rad/s
  for (nlohmann::json& point : document["points"]) {
    if (point.contains("fixed")) continue;
    const double x = point["position"][0], y = point["position"][1];
    point["velocity"] = {-kRate * y, kRate * x};
  }
  const Start start(scene_of(document, "changed"));
  const Vector3 c = limb.centre, h = limb.hinge;
  const double across = limb.mass * kRate * kRate * cross(h, c)[2];
  const double whole = limb.inertia + limb.mass * dot(h, h), both = limb.mass * dot(h, c);
  const double at_origin = -kG * limb.mass * (c[0] + h[0]) + across;
  const double at_hinge = -kG * limb.mass * c[0] - across;
  const double determinant = whole * limb.inertia - both * both;
  const double A = (limb.inertia * at_origin - both * at_hinge) / determinant;
  const double B = (whole * at_hinge - both * at_origin) / determinant;
  const auto turning = [](double angular, const Vector3& r) {
    return cross({0.0, 0.0, angular}, r) - kRate * kRate * r;
  };
  for (const std::string& name : first) start.expect(name, turning(A, place(start.scene, name)));
  for (const std::string& name : second) {
    start.expect(name, turning(A, h) + turning(B, place(start.scene, name) - h));
  }
}

RunSummary simulate(const Scene& scene, double duration, const Observer& observer = {}) {
  RunSettings settings;
  settings.step = chosen(scene.model, {.step = 2e-3});
  settings.duration = duration;
  return run(scene, test::reference(), settings, observer);
}

/// A few values of all parameters, the least ones first.
std::vector<FamilyValues> some_values(const SceneFamily& family) {
  FamilyValues least, more;
  for (const FamilyParameter& one : family.parameters) {
    least.push_back(one.otherwise.value_or(one.least));
    more.push_back(std::min(one.least + 4, one.most));
  }
  return {least, more};
}

TEST(Families, HaveTheSizesOfTheTableAndStartOnTheirConstraints) {
  for (const SceneFamily& family : scene_families()) {
    for (const FamilyValues& values : some_values(family)) {
      const Scene scene = scene_of(family.document(values), family.name);
      SCOPED_TRACE(family.name + std::to_string(values[0]));
      EXPECT_EQ(scene.model.variables(), family.size(values).variables);
      EXPECT_EQ(scene.model.constraints(), family.size(values).constraints);
      EXPECT_LT(scene.assembly.position_correction, 1e-12);
      EXPECT_LT(scene.assembly.velocity_correction, 1e-12);
    }
  }
}

TEST(Families, AreSimulatedAndConserveEnergy) {
  for (const SceneFamily& family : scene_families()) {
    SCOPED_TRACE(family.name);
    for (const FamilyValues& values : some_values(family)) {
      const Scene scene = scene_of(family.document(values), family.name);
      const RunSummary summary = simulate(scene, 1.0);
      EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
      EXPECT_EQ(summary.energy_drift_max.has_value(), family.name != std::string("vehicle"));
      EXPECT_LT(summary.energy_drift_max.value_or(0.0), 2e-3);
    }
  }
}

TEST(Families, LoadByName) {
  EXPECT_EQ(load_scene("grid:2x3").model.variables(), 24);
  EXPECT_EQ(load_scene("chain:5").model.variables(), 10);
  EXPECT_EQ(load_scene("chain:5,dimension=3").model.variables(), 15);
  EXPECT_EQ(load_scene("flexible:2,nodes=5").model.variables(), 16);
  EXPECT_EQ(load_scene("ladder:12").name, "ladder:12");
  EXPECT_EQ(load_scene("chain:20000").model.variables(), 40'000);
}

TEST(Families, RefuseWhatTheyDoNotTake) {
  for (const char* name : {"chain:", "chain:0", "chain:-1", "chain:+1", "chain:1.5", "chain:1e3",
                           "chain:20001", "chain: 3", "chain:03", "chain:99999999999"}) {
    expect_parts(error_of(name),
                 {name, "for N, allowed is a whole number from 1 to 20000 without sign"});
  }
  expect_parts(error_of("loop:3"), {"for N, allowed is a whole number from 4 to"});
  expect_parts(error_of("grid:3"), {"\"3\" as its size, allowed is grid:NxM (N from 1 to 5000;"});
  expect_parts(error_of("chain:3x4"), {"\"3x4\" as its size", "chain:N[,dimension=D]"});
  expect_parts(error_of("grid:3x0"), {"\"0\" for M"});
  expect_parts(error_of("chain:3,dimension=4"), {"\"4\" for dimension", "from 2 to 3"});
  for (const char* option : {"", "dimension", "nodes=3", "fill=0.5"}) {
    expect_parts(error_of(std::string("chain:3,") + option),
                 {"found the option \"" + std::string(option), "dimension from 2 to 3, 2 if left"});
  }
  expect_parts(error_of("flexible:2,nodes=3,nodes=5"), {"the option nodes twice, allowed is once"});
  expect_parts(error_of("chain:20000,dimension=3"), {"60000 variables", "at most 40000"});
  expect_parts(error_of("robot:7"), {"N = 7", "an even number of legs"});
  expect_parts(error_of("chains:3"), {"no such kind of scene", "chain:N[,dimension=D], loop:N",
                                      "flexible:N[,nodes=K]", "mbs list --scenes"});
}

TEST(Families, ChainIsAPendulumOfRods) {
  Start("chain:1").expect_turning("P1", swinging(0.25, 0.5, 1.0 / 3.0));
  const Start two("chain:2");  // Lagrange's equations of two rods at one angle
  const Vector3 across{std::cos(0.25), std::sin(0.25), 0.0};
  const double rate = kG * std::sin(0.25);
  two.expect("P1", (-9.0 / 7.0 * rate) * across);
  two.expect("P2", (-9.0 / 7.0 + 3.0 / 7.0) * rate * across);
}

TEST(Families, SpatialChainGoesRoundLikeAConicalPendulum) {
  const Start one("chain:1,dimension=3");
  const double square = 1.5 * kG / std::cos(0.25);
  one.expect("P1", {-square * std::sin(0.25), 0.0, 0.0});
}

/// Largest difference between one side and the mirror image of the other, over a run.
double asymmetry(const std::string& name, double twice_axis,
                 const std::vector<std::pair<std::string, std::string>>& pairs) {
  const Scene scene = load_scene(name);
  double largest = 0.0, moved = 0.0;
  const RunSummary summary = simulate(scene, 1.0, [&](long, double, const State& state) {
    for (const auto& [left, right] : pairs) {
      const Vector3 l = part(scene, left, state.q), r = part(scene, right, state.q);
      largest = std::max(largest, std::hypot(l[0] + r[0] - twice_axis, l[1] - r[1]));
      moved = std::max(moved, norm(l - place(scene, left)));
    }
  });
  EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
  EXPECT_GT(moved, 0.01);
  return largest;
}

TEST(Families, LoopAndTreeMirrorThemselves) {
  const double span = place(load_scene("loop:7"), "P7")[0];
  EXPECT_LT(asymmetry("loop:7", span, {{"P1", "P6"}, {"P2", "P5"}, {"P3", "P4"}}), 1e-8);
  EXPECT_LT(asymmetry("tree:6", 0.0, {{"P1", "P2"}, {"P3", "P6"}, {"P4", "P5"}}), 1e-8);
}

TEST(Families, TreeOfTwoRodsIsTwoPendulums) {
  const double turning = swinging(0.15, 0.5, 1.0 / 3.0);
  const Start two("tree:2");
  two.expect_turning("P1", -turning);
  two.expect_turning("P2", turning);
}

TEST(Families, LadderKeepsItsRungsLevel) {
  // Two sides of 1 kg and 0.5 m that turn, a rung of 0.5 kg that does not.
  const Start one("ladder:1");
  const double angular = swinging(0.25, 0.5 * (2 * 0.5 + 0.5), 0.25 * (2.0 / 3.0 + 0.5));
  one.expect_turning("A1", angular);
  one.expect("B1", one.acceleration("A1"));
  const Start many("ladder:9");
  for (const char* i : {"1", "5", "9"}) {
    many.expect(std::string("A") + i, many.acceleration(std::string("B") + i));
  }
}

TEST(Families, GridMovesAsOneColumn) {
  // A cord that hangs and turns, and as much weight from beside it that does not.
  const Start one("grid:1x4");
  const double angular = swinging(0.4, 0.5 * (0.5 + 1.0), 0.25 * (1.0 / 3.0 + 1.0));
  const double along = 0.5 * angular, level = along * std::cos(0.4) * std::sqrt(0.5);
  for (const char* name : {"P1_0", "P1_1", "P1_4"}) {
    one.expect(name, {level, along * std::sin(0.4), level});
  }
  const Start many("grid:6x5");
  many.expect("P6_0", many.acceleration("P6_5"));
  many.expect("P3_2", many.acceleration("P3_4"));
}

/// Rods on fixed hinges P0_j: of a rod, a third of its mass and half of its weight are at P1_j. At
/// rest it takes what is along it.
TEST(Families, ClothOfOneRowIsPendulumsWithSpringsBetween) {
  const Start cloth("cloth:1x4");
  const auto at = [&](const std::string& name) { return place(cloth.scene, name); };
  const auto pull = [&](const std::string& here, const std::string& there, double stiffness,
                        double length) {
    const Vector3 r = at(there) - at(here);
    return stiffness * (1.0 - length / norm(r)) * r;
  };
  const double cell = 0.25, diagonal = std::sqrt(2.0) * cell;
  const auto expect = [&](const std::string& column, const Vector3& springs) {
    const Vector3 rod = at("P1_" + column) - at("P0_" + column);
    const Vector3 force = Vector3{0.0, -0.05 * kG, 0.0} + springs;
    cloth.expect("P1_" + column, (3.0 / 0.1) * (force - (dot(force, rod) / dot(rod, rod)) * rod));
  };
  expect("0", pull("P1_0", "P1_1", 10.0, cell) + pull("P1_0", "P0_1", 5.0, diagonal) +
                  pull("P1_0", "P1_2", 2.0, 2.0 * cell));
  expect("1", pull("P1_1", "P1_0", 10.0, cell) + pull("P1_1", "P1_2", 10.0, cell) +
                  pull("P1_1", "P0_0", 5.0, diagonal) + pull("P1_1", "P0_2", 5.0, diagonal) +
                  pull("P1_1", "P1_3", 2.0, 2.0 * cell));
}

TEST(Families, ClothHangsAtRestAndMovesAlikeOnBothSides) {
  const Start many("cloth:4x5");
  const Vector3 left = many.acceleration("P4_1");
  many.expect("P4_3", {-left[0], left[1], left[2]});
  nlohmann::json document = load_document("cloth:3x4");
  for (nlohmann::json& point : document["points"]) {
    const std::string name = point["name"];
    point["position"] = {0.25 * (name.back() - '0'), -0.25 * (name[1] - '0'), 0.0};
  }
  const Start straight(scene_of(document, "changed"));
  for (const double a : straight.state.a) EXPECT_NEAR(a, 0.0, 1e-8);
}

/// Of rods of 4 kg/m.
Limb lattice(const Scene& boom, const std::string& hinge) {
  Limb limb;
  for (const Elements::Rod& rod : boom.elements.rods) {
    const Vector3 a = boom.model.points()[static_cast<std::size_t>(rod.a)].position;
    const Vector3 b = boom.model.points()[static_cast<std::size_t>(rod.b)].position;
    const double mass = 4.0 * norm(a - b);
    limb.mass += mass;
    limb.centre = limb.centre + (mass / 2.0) * (a + b);
    limb.inertia += mass * (dot(a, a) + dot(a, b) + dot(b, b)) / 3.0;
  }
  limb.centre = (1.0 / limb.mass) * limb.centre;
  limb.hinge = place(boom, hinge);
  return limb;
}

TEST(Families, TrussTurnsAsOneBody) {
  const Start boom("truss:1,bays=7");
  const Limb one = lattice(boom.scene, "A7");
  for (const char* name : {"B0_0", "A3", "A7", "B0_7"}) {
    boom.expect_turning(name, -kG * one.mass * one.centre[0] / one.inertia);
  }
}

TEST(Families, TwoLatticesAreADoublePendulum) {
  expect_double_pendulum(load_document("truss:2,bays=3"),
                         lattice(load_scene("truss:1,bays=3"), "A3"), {"A2", "A3", "B0_0", "B0_3"},
                         {"B1_0", "A4", "A6", "B1_3"});
}

TEST(Families, ScissorsHaveOneFreedom) {
  for (const int stages : {1, 7}) {
    const std::string name = "scissors:" + std::to_string(stages);
    nlohmann::json document = load_document(name);
    const double s = std::sin(0.8), c = std::cos(0.8), n = stages, rate = 0.3 / n;
    for (nlohmann::json& spring : document["springs"]) spring["length"] = 0.9 * c;
    const Start gate(scene_of(document, "changed"));
    // (inertia rate^2 / 2)' + V' = 0, all over the angle of the bars, which are 1 m long.
    double inertia = 10.0 * n * n * c * c + 5.0 * s * s;
    double change = (-10.0 * n * n + 5.0) * 2.0 * s * c;
    for (int i = 0; i < stages; ++i) {
      const double height = (i + 0.5) * (i + 0.5);
      inertia += 2 * 2.0 * (s * s / 4.0 + height * c * c + 1.0 / 12.0);
      change += 2 * 2.0 * (0.25 - height) * 2.0 * s * c;
    }
    const double angular = (n * 200.0 * 0.1 * c * s - 0.5 * change * rate * rate) / inertia;
    const Vector3 pin{-c * rate * rate - s * angular,
                      (2.0 * n - 1.0) * (-s * rate * rate + c * angular), 0.0};  // twice
    gate.expect("C" + std::to_string(stages - 1), 0.5 * pin);
  }
}

TEST(Families, OneBodyIsACompoundPendulum) {
  const double x = 0.5 * std::sin(0.2) + 0.05 * std::cos(0.2);  // of the centre
  const double planar = -kG * 2.0 * x / (0.2 + 2.0 * (0.5 * 0.5 + 0.05 * 0.05));
  const auto turning = [](const std::string& name) {
    const Start start(name);
    const Scene& scene = start.scene;
    for (const Point& point : scene.model.points()) {
      if (!point.is_fixed() && !point.is_vector) {
        return cross(point.position, start.acceleration(point.name))[2] /
               (point.position[0] * point.position[0] + point.position[1] * point.position[1]);
      }
    }
    return 0.0;
  };
  EXPECT_NEAR(turning("bodies:1"), planar, 1e-8);
  EXPECT_NEAR(turning("bodies:1,dimension=3"), planar, 1e-8);
}

TEST(Families, TwoBodiesAreADoublePendulum) {
  const Vector3 along{std::sin(0.2), -std::cos(0.2), 0.0},
      across{std::cos(0.2), std::sin(0.2), 0.0};
  expect_double_pendulum(load_document("bodies:2"),
                         {.mass = 2.0,
                          .centre = 0.5 * along + 0.05 * across,
                          .inertia = 0.2 + 2.0 * (0.5 * 0.5 + 0.05 * 0.05),
                          .hinge = along},
                         {"J1"}, {"J2"});
}

/// The first turns about z, the second on it about `a`; 1 rad/s about one of them moves centres at
/// v_j. From rest Lagrange's equations are sum_k H_jk angular_k = -m g (sum of v_j)_y. H_jk has
/// m v_j.v_k of each body, and its 0.2 kg m^2 where both turn it about one axis.
TEST(Families, TwoBodiesInSpaceTurnAboutAxesAtARightAngle) {
  const Vector3 along{std::sin(0.2), -std::cos(0.2), 0.0}, z{0.0, 0.0, 1.0}, a = cross(z, along);
  const Vector3 first = cross(z, 0.5 * along + 0.05 * a + 0.03 * z);
  const Vector3 on_it = 0.5 * along + 0.05 * cross(a, along) + 0.03 * a;  // from J1 to the centre
  const Vector3 carried = cross(z, along + on_it), second = cross(a, on_it);
  const double whole = 0.2 + 0.2 + 2.0 * (dot(first, first) + dot(carried, carried));
  const double both = 2.0 * dot(carried, second), own = 0.2 + 2.0 * dot(second, second);
  const double at_z = -kG * 2.0 * (first[1] + carried[1]), at_a = -kG * 2.0 * second[1];
  const double determinant = whole * own - both * both;
  const double A = (own * at_z - both * at_a) / determinant;
  const double B = (whole * at_a - both * at_z) / determinant;
  const Start arm("bodies:2,dimension=3");
  arm.expect("J1", A * cross(z, along));
  arm.expect("J2", (2.0 * A) * cross(z, along) + B * cross(a, along));
}

/// Of the road under an axle at the start.
struct RoadUnder {
  double height = 0.0, rate = 0.0;  // m, m/s
};
RoadUnder road_under(int axle) {
  const double phase = -2.0 * std::numbers::pi * 1.5 * axle / 10.0;
  return {0.01 * std::sin(phase), 0.01 * 2.0 * std::numbers::pi * std::cos(phase)};
}

TEST(Families, VehicleStandsUntilTheRoadMoves) {
  const Start vehicle("vehicle:5");
  for (int i = 0; i < 5; ++i) {
    const std::string number = std::to_string(i);
    const auto [height, rate] = road_under(i);
    vehicle.expect("hub" + number, {0.0, (400e3 * height + 2e3 * rate) / 400.0, 0.0});
    vehicle.expect("mount" + number, {});
  }
}

/// Hubs move, the chassis rests, and springs are 2 cm longer than the suspensions. Arms are level:
/// a hub turns about its pivot, and its arm passes no vertical force on. All pivots are at one
/// height and one keeps its x: so the chassis pitches about a point there, 0.3 m below its centre.
TEST(Families, VehicleGoesByItsSpringsDampersAndArms) {
  constexpr std::array<double, 3> kUp{0.3, -0.1, 0.2};  // of the hubs, m/s
  nlohmann::json document = load_document("vehicle:3");
  for (nlohmann::json& spring : document["springs"]) {
    const std::string upper = spring["between"][0];
    if (upper.starts_with("mount")) spring["length"] = 0.45 + 0.02;
  }
  for (nlohmann::json& point : document["points"]) {
    const std::string name = point["name"];
    if (!name.starts_with("hub")) continue;
    point["velocity"] = {0.0, kUp[static_cast<std::size_t>(name.back() - '0')]};
  }
  const Start vehicle(scene_of(document, "changed"));
  double lift = 0.0, moment = 0.0;  // N, N m
  for (int i = 0; i < 3; ++i) {
    const auto [height, rate] = road_under(i);
    const double up = kUp[static_cast<std::size_t>(i)];
    const double suspension = 150e3 * 0.02 + 10e3 * up;
    const double tyre = 2400.0 * kG + 400e3 * height + 2e3 * (rate - up);
    vehicle.expect("hub" + std::to_string(i),
                   {up * up / 0.4, (tyre - suspension) / 400.0 - kG, 0.0});
    lift += suspension;
    moment += 1.5 * (1 - i) * suspension;
  }
  const double pitch = moment / (6000.0 * ((4.5 * 4.5 + 1.0) / 12.0 + 0.3 * 0.3));
  for (int i = 0; i < 3; ++i) {  // mounts are 0.45 m above the pivots
    vehicle.expect("mount" + std::to_string(i),
                   {-0.45 * pitch, lift / 6000.0 - kG + 1.5 * (1 - i) * pitch, 0.0});
  }
}

nlohmann::json robot_at_rest(int legs) {
  nlohmann::json document = load_document("robot:" + std::to_string(legs));
  for (nlohmann::json& point : document["points"]) point.erase("velocity");
  for (const char* key : {"velocity", "angular_velocity"}) document["bodies"][0].erase(key);
  return document;
}

TEST(Families, RobotStandsWithoutTheBlow) {
  for (const int legs : {6, 10}) {
    const Start robot(scene_of(robot_at_rest(legs), "changed"));
    for (const double a : robot.state.a) EXPECT_NEAR(a, 0.0, 1e-8);
  }
}

/// What the platform's v and omega, six numbers, make of the velocity of a point.
using PlatformMoves = Eigen::Matrix<double, 3, 6>;

/// A leg, as the platform's motion sees it.
struct RobotLeg {
  PlatformMoves joint, knee;
  Eigen::Vector3d pull;  // of its spring on the knee, 1
};

/// The joint moves by v + omega x r, the knee by t (u.joint) / (t.u): t is what it moves by when it
/// turns about its hinge, u the upper link, whose length stays.
RobotLeg robot_leg(int i, int legs) {
  const double at = 2.0 * std::numbers::pi * i / legs, top = at + (i % 2 == 0 ? 0.5 : -0.5);
  const Eigen::Vector3d out(std::cos(at), 0.0, std::sin(at)), up(0.0, 1.0, 0.0);
  const Eigen::Vector3d lower = 0.5 * (std::cos(1.1) * out + std::sin(1.1) * up);
  const Eigen::Vector3d r = 0.7 * Eigen::Vector3d(std::cos(top), 0.0, std::sin(top));
  const Eigen::Vector3d u = 0.9 * up + r - out - lower;
  const Eigen::Vector3d t = Eigen::Vector3d(-std::sin(at), 0.0, std::cos(at)).cross(lower);
  RobotLeg leg;
  leg.joint.leftCols<3>().setIdentity();
  for (int k = 0; k < 3; ++k) leg.joint.col(3 + k) = Eigen::Vector3d::Unit(k).cross(r);
  leg.knee = t * (u.transpose() * leg.joint) / t.dot(u);
  leg.pull = (0.5 * up - 0.5 * out - lower).normalized();  // to the post, from the knee
  return leg;
}

/// From rest, each spring tightened by another length: H x = Q of the platform's six freedoms x.
TEST(Families, RobotMovesAsItsSpringsPull) {
  constexpr int kLegs = 8;
  constexpr double kMass = 20.0 * kLegs, kAcross = kMass * (0.7 * 0.7 / 4.0 + 0.01);
  nlohmann::json document = robot_at_rest(kLegs);
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  H.diagonal() << kMass, kMass, kMass, kAcross, kMass * 0.7 * 0.7 / 2.0, kAcross;
  Eigen::Matrix<double, 6, 1> Q = Eigen::Matrix<double, 6, 1>::Zero();
  Q[1] = -kMass * kG;
  for (int i = 0; i < kLegs; ++i) {
    const auto& [joint, knee, pull] = robot_leg(i, kLegs);
    // Of a rod a third is at each end and a sixth across; 2 kg below the knee, 1 kg above.
    H += knee.transpose() * knee + joint.transpose() * joint / 3.0 +
         (knee.transpose() * joint + joint.transpose() * knee) / 6.0;
    Q -= kG * (1.5 * knee.row(1) + 0.5 * joint.row(1)).transpose();
    // Stretched by 2 cm it bears its share of 20 kg and the links, by the work of rising.
    const double standing = kG * (20.5 + 1.5 * knee(1, 1)) / pull.dot(knee.col(1));
    const double tighter = 0.001 * (i + 1);  // m
    Q += standing * (1.0 + tighter / 0.02) * knee.transpose() * pull;
    nlohmann::json& length = document["springs"][static_cast<std::size_t>(i)]["length"];
    length = length.get<double>() - tighter;
  }
  const Eigen::Matrix<double, 6, 1> x = H.ldlt().solve(Q);
  const Start robot(scene_of(document, "changed"));
  for (int i = 0; i < kLegs; ++i) {
    const RobotLeg leg = robot_leg(i, kLegs);
    const Eigen::Vector3d joint = leg.joint * x, knee = leg.knee * x;
    robot.expect("P" + std::to_string(i), {joint[0], joint[1], joint[2]});
    robot.expect("K" + std::to_string(i), {knee[0], knee[1], knee[2]});
  }
}

TEST(Families, StarsBladesSwingAboutTheRadius) {
  const Start star("star:8");
  for (int i = 0; i < 8; ++i) {
    const std::string number = std::to_string(i);
    const Vector3 rim = place(star.scene, "R" + number);
    const Vector3 blade = place(star.scene, "T" + number) - rim;
    // Hinged at 0.5 m, 1 m long: angle'' = -(3/2) (0.5 / 1) 9 sin(angle).
    const double swing = -0.75 * 9.0 * (i % 2 == 0 ? 1.0 : -1.0) * std::sin(0.2);
    star.expect("R" + number, -9.0 * rim);
    star.expect("T" + number, -9.0 * (rim + blade) + cross({0.0, 0.0, swing}, blade));
  }
}

TEST(Families, ClustersBreathe) {
  nlohmann::json document = load_document("clusters:2,size=7");
  document["gravity"] = {0.0, 0.0};
  const Scene scene = load_scene("clusters:2,size=7");
  for (nlohmann::json& spring : document["springs"]) {
    const std::string a = spring["between"][0], b = spring["between"][1];
    spring["length"] = (a[0] == 'A' ? 1.0 : 1.01) * norm(place(scene, a) - place(scene, b));
  }
  const Start start(scene_of(document, "changed"));
  Vector3 centre{};
  for (int i = 0; i < 7; ++i) centre = centre + (1 / 7.0) * place(scene, "P0_" + std::to_string(i));
  for (const char* name : {"P0_1", "P0_4", "P0_6"}) {  // the chain is at P0_0
    start.expect(name, 0.01 * 144.0 * (place(scene, name) - centre));
  }
}

/// Held straight where a beam would bend, and only there.
TEST(Families, TwoFlexibleBeamsHeldStraightAreADoublePendulum) {
  nlohmann::json document = load_document("flexible:2,nodes=5");
  for (const nlohmann::json& spring : document["torsion_springs"]) {
    document["constraints"].push_back({{"name", spring["name"]},
                                       {"type", "angle"},
                                       {"first", spring["from"]},
                                       {"second", spring["to"]}});
  }
  document.erase("torsion_springs");
  const Vector3 along{std::sin(0.05), -std::cos(0.05), 0.0};
  const Vector3 across{std::cos(0.05), std::sin(0.05), 0.0};
  expect_double_pendulum(document,
                         {.mass = 10.0,
                          .centre = 2.0 * along - 0.1 * across,
                          .inertia = 10.0 * (16.0 / 3.0 + 0.1 * 0.1 + 0.05 * 0.05),
                          .hinge = 4.0 * along},
                         {"P1", "P4"}, {"P5", "P8"});
}

TEST(Families, FlexibleBeamTurnsAsABodyAndBendsAsABeam) {
  constexpr int kNodes = 15;
  const Scene scene = load_scene("flexible:1,nodes=15");
  EXPECT_EQ(tangent_nonzeros(scene.model), 28 * 28);
  std::vector<double> turn;  // about P0, which is fixed, at 1 rad/s
  for (int i = 1; i < kNodes; ++i) {
    const Vector3 v = cross({0.0, 0.0, 1.0}, place(scene, "P" + std::to_string(i)));
    turn.insert(turn.end(), {v[0], v[1]});
  }
  EXPECT_NEAR(kinetic_energy(scene.model, turn),
              0.5 * 10.0 * (16.0 / 3.0 + 0.1 * 0.1 + 0.05 * 0.05), 1e-9);
  double power = 0.0;  // of gravity: the centre is 2 m down the beam, 0.1 m to its right
  for (std::size_t i = 0; i < turn.size(); ++i) power += turn[i] * scene.model.force()[i];
  EXPECT_NEAR(power, -kG * 10.0 * (2.0 * std::sin(0.05) - 0.1 * std::cos(0.05)), 1e-9);
  // Rayleigh's quotient of half a sine across the beam against (pi/L)^4 EI/(m/L), EI = 60 N m^2.
  const Eigen::MatrixXd M = beam_mass({.nodes = kNodes, .length = 4.0, .mass = 10.0});
  const double h = 4.0 / (kNodes - 1);
  Eigen::VectorXd across = Eigen::VectorXd::Zero(2 * kNodes);
  for (int i = 0; i < kNodes; ++i) {
    across[2 * i + 1] = std::sin(std::numbers::pi * i / (kNodes - 1));
  }
  double twice_potential = 0.0;
  ASSERT_EQ(scene.model.torsion_springs().size(), kNodes - 2U);
  for (int i = 1; i + 1 < kNodes; ++i) {
    const double bend = (across[2 * i + 3] - 2.0 * across[2 * i + 1] + across[2 * i - 1]) / h;
    twice_potential +=
        scene.model.torsion_springs()[static_cast<std::size_t>(i - 1)].stiffness * bend * bend;
  }
  const double exact = std::pow(std::numbers::pi / 4.0, 4) * 60.0 / (10.0 / 4.0);
  EXPECT_NEAR(twice_potential / across.dot(M * across), exact, 0.01 * exact);
}

}  // namespace
}  // namespace mbs
