// Bodies that share points or vectors must have them in the same shape.
#include <gtest/gtest.h>

#include <string>

#include "support/scene_support.hpp"

namespace mbs {
namespace {

std::string planar(const std::string& k, const std::string& l) {
  return R"({"bodies": [
    {"name": "K", "mass": 1, "inertia": 0.1, "centre": [0.5, 0.4], "pose": {}, "points": {)" +
         k + R"(}},
    {"name": "L", "mass": 1, "inertia": 0.1, "centre": [0.5, 0.3], "points": {)" +
         l + "}}]}";
}

TEST(SharedShape, LengthsInThePlane) {
  const std::string l = R"("A": [0, 0], "B": [1.5, 0], "C": [1, 1])";
  expect_parts(parse_error_of(planar(R"("A": [0, 0], "B": [1, 0])", l)),
               {"bodies[1]: found A and B 1.5 m apart in \"L\", 1 m in bodies[0] \"K\"",
                "allowed is one shape"});
  EXPECT_EQ(parse_error_of(planar(R"("A": [0, 0], "B": [1.5, 0])", l)), "no error");
  EXPECT_EQ(parse_error_of(planar(R"("A": [7, 1], "B": [7, 2.5])", l)), "no error");
}

TEST(SharedShape, ThirdPointInThePlane) {
  const std::string l = R"("A": [0, 0], "B": [1, 0], "C": [1, 1])";
  expect_parts(
      parse_error_of(planar(R"("A": [0, 0], "B": [1, 0], "C": [1, -1], "Z": [0, 0.5])", l)),
      {"bodies[", "\"K\"", "\"L\"", "clockwise in", "counter-clockwise"});
  expect_parts(
      parse_error_of(planar(R"("A": [0, 0], "B": [1, 0], "C": [1, 1.2], "Z": [0, 0.5])", l)),
      {"\"K\"", "\"L\"", "1.41421356 m", "1.56204994 m"});
  EXPECT_EQ(parse_error_of(planar(R"("A": [0, 0], "B": [1, 0], "C": [1, 1], "Z": [0, 0.5])", l)),
            "no error");
}

std::string spatial(const std::string& k, const std::string& l) {
  return R"({"dimension": 3, "bodies": [
    {"name": "K", "mass": 1, "inertia": [1, 1, 1], "pose": {}, )" +
         k + R"(}, {"name": "L", "mass": 1, "inertia": [1, 1, 1], )" + l + "}]}";
}

TEST(SharedShape, LengthsAndAnglesInSpace) {
  const std::string k = R"("points": {"A": [0, 0, 0], "B": [1, 0, 0]})";
  expect_parts(
      parse_error_of(spatial(
          k, R"("pose": {}, "points": {"A": [0, 0, 0], "B": [1.5, 0, 0], "C": [0, 1, 0]})")),
      {"A and B 1.5 m apart in \"L\", 1 m in bodies[0] \"K\""});
  const std::string u = R"("points": {"A": [0, 0, 0]}, "vectors": {"u": [1, 0, 0], "w": )";
  // Angles of 1.5 and 1.4 rad.
  const std::string k_vectors = u + "[0.0707372016677029, 0.9974949866040544, 0]}";
  expect_parts(parse_error_of(spatial(
                   k_vectors, u + "[0.16996714290024104, 0.98544972998846, 0]}, \"pose\": {}")),
               {"1.4 rad in \"L\", 1.5 rad in bodies[0] \"K\""});
  EXPECT_EQ(parse_error_of(spatial(k_vectors, k_vectors)), "no error");
}

TEST(SharedShape, MirrorImageInSpace) {
  const std::string k = R"("points": {"A": [0, 0, 0], "B": [1, 0, 0], "C": [0, 1, 0], "D": )";
  expect_parts(parse_error_of(spatial(k + "[0, 0, 1]}", k + R"([0, 0, -1]})")),
               {"bodies[1]: found points and vectors that start as the mirror image"});
  EXPECT_EQ(parse_error_of(spatial(k + "[0, 0, 1]}", k + R"([0, 0, 1]})")), "no error");
}

}  // namespace
}  // namespace mbs
