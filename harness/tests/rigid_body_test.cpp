// A body's mass matrix and constraints are those of a rigid body, whatever carries its coordinates.
#include "scene_file/body/rigid_body.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>

#include "model_math/jacobian_rank.hpp"
#include "model_math/kinematics.hpp"
#include "scene_file/body/rigid_fit.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

/// One body in free flight with springs at its points, so that these are coordinates.
struct Case {
  int dimension;
  int points;         // at springs
  double size = 1.0;  // m
};

void PrintTo(const Case& body, std::ostream* out) {
  *out << body.dimension << "D_" << body.points << (body.size < 1.0 ? "_small" : "");
}

class RigidBody : public testing::TestWithParam<Case> {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vector3 random_vector(double size) {
    Vector3 x{uniform(-size, size), uniform(-size, size), uniform(-size, size)};
    if (GetParam().dimension == 2) x[2] = 0.0;
    return x;
  }
  std::string text(const Vector3& x) const {
    return GetParam().dimension == 2 ? fmt::format("[{:.17g}, {:.17g}]", x[0], x[1])
                                     : fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x[0], x[1], x[2]);
  }

  /// The body's mass, centre and inertia, its pose and its points, random, as JSON.
  SceneData random_scene() {
    const auto [dimension, points, size] = GetParam();
    inertia_.mass = uniform(0.5, 5.0);
    inertia_.centre = random_vector(size);
    const Eigen::Vector3d moments(uniform(0.1, 1.0), uniform(0.1, 1.0), uniform(0.1, 1.0));
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1))
            .normalized();
    const Eigen::Matrix3d S = turn.toRotationMatrix() * moments.asDiagonal() *
                              turn.toRotationMatrix().transpose() * inertia_.mass * size * size;
    const Eigen::Matrix3d J = S.trace() * Eigen::Matrix3d::Identity() - S;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        inertia_.tensor[i][j] = J(static_cast<int>(i), static_cast<int>(j));
      }
    }
    std::string items, springs;
    for (int i = 0; i < points; ++i) {
      items += fmt::format("{}\"P{}\": {}", i > 0 ? ", " : "", i, text(random_vector(size)));
      springs += fmt::format(R"({}{{"between": ["P{}", "G"]}})", i > 0 ? ", " : "", i);
    }
    const auto& t = inertia_.tensor;
    const std::string json = fmt::format(
        R"({{"dimension": {}, "gravity": {}, "points": [{{"name": "G", "position": {}, "fixed": true}}],
            "bodies": [{{"name": "K", "mass": {:.17g}, "centre": {}, "inertia": {},
            "points": {{{}}}, "pose": {{"position": {}}} }}], "springs": [{}],
            "outputs": [{{"name": "ground", "position": "G"}}] }})",
        dimension, text(gravity()), text({100, 0, 0}), inertia_.mass, text(inertia_.centre),
        dimension == 2 ? fmt::format("{:.17g}", t[2][2])
                       : fmt::format("[{:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}]",
                                     t[0][0], t[1][1], t[2][2], t[0][1], t[0][2], t[1][2]),
        items, text({0, 0, 0}), springs);
    return parse_scene(json, "random");
  }

  [[nodiscard]] Vector3 gravity() const {
    return {0.3, -9.81, GetParam().dimension == 2 ? 0.0 : 1.2};
  }

  std::mt19937 random_{7};
  Inertia inertia_;
};

TEST_P(RigidBody, EnergyWorkAndConstraintsOfRandomMotions) {
  for (int round = 0; round < 20; ++round) {
    const SceneData data = random_scene();
    const Model model(data.model);
    const int freedoms = GetParam().dimension == 2 ? 3 : 6;
    EXPECT_EQ(model.constraints(), model.variables() - freedoms);
    EXPECT_EQ(jacobian_rank(model, model.initial_position()), model.constraints());
    // The start has the body's pose: local coordinates are global ones.
    Vector3 spin = random_vector(2.0);
    if (GetParam().dimension == 2) spin = {0.0, 0.0, uniform(-2.0, 2.0)};
    const Vector3 linear = random_vector(3.0);
    Vector3 rotation = random_vector(3.0);
    if (GetParam().dimension == 2) rotation = {0.0, 0.0, uniform(-3.0, 3.0)};
    const Pose pose{random_vector(2.0), rotation_matrix(rotation)};
    std::vector<double> q(static_cast<std::size_t>(model.variables())), v(q.size());
    for (const Point& point : model.points()) {
      if (point.is_fixed()) continue;
      const Vector3 r = pose.place(point.position, point.is_vector);
      const Vector3 rate = point.is_vector ? cross(spin, r) : linear + cross(spin, r - pose.origin);
      for (int axis = 0; axis < model.dimension(); ++axis) {
        q[static_cast<std::size_t>(point.offset + axis)] = r[static_cast<std::size_t>(axis)];
        v[static_cast<std::size_t>(point.offset + axis)] = rate[static_cast<std::size_t>(axis)];
      }
    }
    const Vector3 centre = pose.place(inertia_.centre, false);
    const Vector3 centre_rate = linear + cross(spin, centre - pose.origin);
    const Vector3 local_spin = multiply_transposed(pose.R, spin);
    const double expected = 0.5 * inertia_.mass * dot(centre_rate, centre_rate) +
                            0.5 * dot(local_spin, multiply(inertia_.tensor, local_spin));
    EXPECT_NEAR(kinetic_energy(model, v), expected, 1e-12 * expected);
    double work = 0.0, start = 0.0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      work += model.force()[i] * q[i];
      start += model.force()[i] * model.initial_position()[i];
    }
    const double fallen = inertia_.mass * dot(gravity(), centre - inertia_.centre);
    EXPECT_NEAR(work - start, fallen, 1e-12 * (1.0 + std::abs(work) + std::abs(start)));
    std::vector<double> phi(static_cast<std::size_t>(model.constraints()));
    evaluate_constraints(model, 0.0, q, phi);
    const double size = 1.0 + GetParam().size;
    for (const double value : phi) EXPECT_NEAR(value, 0.0, 1e-12 * size * size);
    constraint_rate(model, 0.0, q, v, phi);
    for (const double value : phi) EXPECT_NEAR(value, 0.0, 1e-11 * size * size);
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, RigidBody,
                         testing::Values(Case{2, 0}, Case{2, 1}, Case{2, 2}, Case{2, 3}, Case{2, 6},
                                         Case{2, 4, 1e-2}, Case{3, 0}, Case{3, 1}, Case{3, 2},
                                         Case{3, 3}, Case{3, 4}, Case{3, 5}, Case{3, 9},
                                         Case{3, 6, 1e-2}),
                         testing::PrintToStringParamName());

TEST(BodyMass, VectorsAndPointsGiveTheSameEnergy) {
  // A box turning about its centre: any basis, with vectors in it or beyond it, says the same.
  const Inertia box{2.0, {0.1, 0.2, 0.3}, {{{0.5, 0.01, 0.0}, {0.01, 0.6, 0.0}, {0.0, 0.0, 0.7}}}};
  const std::vector<BodyPlace> points{
      {{0, 0, 0}, false}, {{1, 0, 0}, false}, {{0, 1, 0}, false}, {{0, 0, 1}, false}};
  const std::vector<BodyPlace> mixed{
      {{0.4, 0, 0}, false}, {{1, 0, 0}, true}, {{0, 0.6, 0.8}, true}, {{0, 0, 2}, false}};
  const std::vector<BodyPlace> further{{{0, 1, 0}, true}, {{0.3, -0.7, 0.2}, false}};
  const Vector3 spin{0.3, -1.2, 2.0}, linear{1.0, 0.5, -0.2};
  const Vector3 rate = linear + cross(spin, box.centre);
  const double expected =
      0.5 * box.mass * dot(rate, rate) + 0.5 * dot(spin, multiply(box.tensor, spin));
  const auto velocity = [&](const BodyPlace& place) {
    return place.is_vector ? cross(spin, place.local) : linear + cross(spin, place.local);
  };
  for (const auto& basis : {points, mixed}) {
    for (const auto& more : {std::vector<BodyPlace>{}, further}) {
      const BodyMass body(box, 3, 1.0, basis, more);
      double energy = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
          energy += 0.5 * body.mass(i, j).real() * dot(velocity(basis[i]), velocity(basis[j]));
        }
      }
      for (std::size_t k = 0; k < more.size(); ++k) {
        EXPECT_GT(body.share(k), 0.0);
        energy += 0.5 * body.share(k) * dot(velocity(more[k]), velocity(more[k]));
      }
      EXPECT_NEAR(energy, expected, 1e-12 * expected);
    }
  }
}

TEST(BodyMass, OneFurtherPlaceTakesHalfOfWhatItCan) {
  const Inertia plate{3.0, {0.0, 0.0, 0.0}, {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0.3}}}};
  const std::vector<BodyPlace> basis{{{-1, 0, 0}, false}, {{1, 0, 0}, false}};
  const BodyMass body(plate, 2, 1.0, basis, {{{0, 0, 0}, false}});
  EXPECT_NEAR(body.share(0), 1.5, 1e-14);  // at the centre all of the mass could go there
}

TEST(Inertia, TriangleInequality) {
  const auto tensor = [](double x, double y, double z) {
    return Inertia{1.0, {}, {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}}};
  };
  EXPECT_TRUE(is_inertia(tensor(1, 1, 1.9), 3));
  EXPECT_TRUE(is_inertia(tensor(1.0, 1.0, 1e-4), 3));
  EXPECT_FALSE(is_inertia(tensor(1, 1, 2.1), 3));
  EXPECT_FALSE(is_inertia(tensor(1, 1, 2), 3));  // flat: no thickness
  EXPECT_FALSE(is_inertia(tensor(1, 1, 0), 3));
  EXPECT_FALSE(is_inertia(tensor(-1, -1, -1), 3));
  Inertia tilted = tensor(1, 1, 1);
  tilted.tensor[0][1] = tilted.tensor[1][0] = 1.5;
  EXPECT_FALSE(is_inertia(tilted, 3));
}

TEST(Inertia, PointMassIsMerged) {
  const Inertia bar{2.0, {1.0, 0.0, 0.0}, {{{0.1, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}}};
  const Inertia merged = with_point_mass(bar, {4.0, 0.0, 0.0}, 1.0, 3);
  EXPECT_DOUBLE_EQ(merged.mass, 3.0);
  EXPECT_DOUBLE_EQ(merged.centre[0], 2.0);
  EXPECT_DOUBLE_EQ(merged.tensor[2][2], 0.5 + 2.0 * 1 + 1.0 * 4);
  EXPECT_DOUBLE_EQ(merged.tensor[0][0], 0.1);
}

TEST(RigidFit, RecoversPoseAndMotion) {
  const Pose pose{{1, 2, 3}, rotation_matrix({0.4, -2.0, 1.0})};
  std::vector<Sighting> seen;
  for (const Vector3& local : {Vector3{0, 0, 0}, Vector3{1, 0, 0}, Vector3{0.3, 0.8, 0}}) {
    seen.push_back({local, pose.place(local, false)});
  }
  const auto fitted = fit_pose(seen, 3, 1.0);
  ASSERT_TRUE(fitted.has_value());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(fitted->origin[i], pose.origin[i], 1e-14);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(fitted->R[i][j], pose.R[i][j], 1e-14);
  }
  seen.pop_back();  // two points leave a turn open in space, not in the plane
  EXPECT_FALSE(fit_pose(seen, 3, 1.0));
  EXPECT_TRUE(fit_pose({{{0, 0, 0}, {1, 1, 0}}, {{2, 0, 0}, {1, 3, 0}}}, 2, 1.0));
  EXPECT_FALSE(fit_pose({{{0, 0, 0}, {1, 1, 0}}}, 2, 1.0));
  EXPECT_FALSE(fit_pose({}, 2, 1.0));

  const auto twist = fit_twist({{{0, 0, 0}, {0, 0, 0}}, {{2, 0, 0}, {0, 3, 0}}}, 2);
  ASSERT_TRUE(twist.has_value());
  EXPECT_NEAR(twist->spin[2], 1.5, 1e-14);
  EXPECT_NEAR(twist->of_point({0, 1, 0})[0], -1.5, 1e-14);
  EXPECT_FALSE(fit_twist({{{2, 0, 0}, {0, 3, 0}}}, 2));
  // In space two points leave a turn about their line open, which a vector closes.
  std::vector<Sighting> moving{{{0, 0, 0}, {0, 0, 0}}, {{2, 0, 0}, {0, 3, 0}}};
  EXPECT_FALSE(fit_twist(moving, 3));
  moving.push_back({{0, 0, 1}, {0, -0.5, 0}, true});
  const auto turning = fit_twist(moving, 3);
  ASSERT_TRUE(turning.has_value());
  EXPECT_NEAR(turning->spin[0], 0.5, 1e-14);
  EXPECT_NEAR(turning->spin[2], 1.5, 1e-14);
}

}  // namespace
}  // namespace mbs
