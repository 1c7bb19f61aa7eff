// What `mbs describe` says about scenes whose numbers are known.
#include "scene/describe.hpp"

#include <gtest/gtest.h>

namespace mbs {
namespace {

TEST(Describe, FourBar) {
  const auto d = describe_json(load_scene("four-bar:2"));
  EXPECT_EQ(d["scene"], "four-bar:2");
  EXPECT_EQ(d["variables"], 6);
  EXPECT_EQ(d["constraints"], 5);
  EXPECT_EQ(d["free_points"], 3);
  EXPECT_EQ(d["fixed_points"], 3);
  EXPECT_EQ(d["jacobian_rank"], 5);
  EXPECT_EQ(d["degrees_of_freedom"], 1);
  EXPECT_EQ(d["degrees_of_freedom_from"], "n - rank");
  EXPECT_EQ(d["mass"]["nonzeros"], 6 + 2 * 4);
  EXPECT_EQ(d["jacobian"]["nonzeros"], 3 * 2 + 2 * 4);
  EXPECT_EQ(d["jacobian"]["fill"], 14.0 / 30.0);
  EXPECT_EQ(d["tangent"]["nonzeros"], 28);
  EXPECT_EQ(d["tangent"]["fill"], 28.0 / 36.0);
  EXPECT_EQ(d["terms"]["gravity"], true);
  EXPECT_EQ(d["terms"]["dot_constraints"], 5);
  EXPECT_EQ(d["terms"]["linear_constraints"], 0);
  EXPECT_EQ(d["terms"]["damping"], false);
  EXPECT_TRUE(d["artificial_fill"].is_null());
}

TEST(Describe, Text) {
  const std::string text = describe_text(load_scene("four-bar:2"));
  for (const char* part :
       {"coordinates n         6 (3 free", "constraints m         5\n",
        "degrees of freedom    1 (n - rank of the Jacobian, 5",
        "terms present         gravity (Q), quadratic constraints (5), fixed points (3)\n",
        "terms absent          linear constraints, damping (C), stiffness (K), driven",
        "14 non-zeros, 46.67 % of m n", "28 non-zeros, 77.78 % of n^2"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nnot in\n" << text;
  }
  EXPECT_EQ(text.find("artificial"), std::string::npos);
}

TEST(Describe, ArtificialFill) {
  const Scene scene = load_scene("four-bar:5,fill=0.50");
  const auto d = describe_json(scene);
  EXPECT_EQ(d["artificial_fill"]["asked"], 0.5);
  EXPECT_EQ(d["artificial_fill"]["natural"], 64.0 / 144.0);
  EXPECT_EQ(d["artificial_fill"]["reached"], 0.5);
  EXPECT_EQ(d["artificial_fill"]["seed"], kFillSeed);
  EXPECT_EQ(d["tangent"]["fill"], 0.5);
  EXPECT_NE(describe_text(scene).find("asked 50 %, natural 44.44 %, reached 50 %, seed 607615"),
            std::string::npos);
}

TEST(Describe, LargeScenesAreCounted) {
  const Scene scene = load_scene("four-bar:500");
  const auto d = describe_json(scene);
  EXPECT_TRUE(d["jacobian_rank"].is_null());
  EXPECT_EQ(d["degrees_of_freedom"], 1);
  EXPECT_EQ(d["degrees_of_freedom_from"], "n - m");
  EXPECT_NE(describe_text(scene).find("1 (n - m; the rank is computed up to n = 400)"),
            std::string::npos);
}

TEST(Describe, RankShowsDegreesOfFreedomThatCountingMisses) {
  // Two points on one rail each, and a third constraint that follows from the rails.
  const Scene scene{"test",
                    Model(parse_scene(R"({"gravity": [0, 0], "points": [
      {"name": "B", "position": [0, 1]}, {"name": "C", "position": [2, 1]}],
      "masses": [{"point": "B", "mass": 1}, {"point": "C", "mass": 1}],
      "constraints": [{"type": "linear", "terms": [{"point": "B", "axis": "y", "coefficient": 1}]},
                      {"type": "linear", "terms": [{"point": "C", "axis": "y", "coefficient": 1}]},
                      {"type": "linear", "terms": [{"point": "B", "axis": "y", "coefficient": 1},
                                                   {"point": "C", "axis": "y", "coefficient": 1}]}
      ]})",
                                      "test")),
                    {},
                    {}};
  const auto d = describe_json(scene);
  EXPECT_EQ(d["constraints"], 3);
  EXPECT_EQ(d["degrees_of_freedom"], 2);
  EXPECT_EQ(d["terms"]["gravity"], false);
  EXPECT_NE(describe_text(scene).find("terms absent          gravity (Q), quadratic"),
            std::string::npos);
}

TEST(Describe, FreeFlightHasNoConstraints) {
  const Scene scene{"test",
                    Model(parse_scene(R"({"points": [{"name": "B", "position": [0, 1]}],
                                          "masses": [{"point": "B", "mass": 1}]})",
                                      "test")),
                    {},
                    {}};
  const auto d = describe_json(scene);
  EXPECT_EQ(d["constraints"], 0);
  EXPECT_EQ(d["degrees_of_freedom"], 2);
  EXPECT_EQ(d["jacobian"]["fill"], 0.0);
}

}  // namespace
}  // namespace mbs
