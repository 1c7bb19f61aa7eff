// Mass matrices of a scene file: what they become, and which are refused.
#include <gtest/gtest.h>

#include "support/scene_support.hpp"

namespace mbs {
namespace {

/// A rod of 6 kg from A to B, of which A is held as `hold` says, written as a matrix.
std::string rod(const std::string& hold,
                const std::string& matrix = "[[2], [0, 2], [1, 0, 2], [0, 1, 0, 2]]",
                const std::string& points = R"(["A", "B"])") {
  return R"({"points": [{"name": "A", "position": [0, 1])" + hold +
         R"(}, {"name": "B", "position": [2, 1]}], "mass_matrices": [{"points": )" + points +
         R"(, "matrix": )" + matrix + R"(}], "constraints": [{"type": "distance",
         "between": ["A", "B"]}]})";
}

/// The same as one of "rods".
std::string as_rod(const std::string& scene) {
  return scene.substr(0, scene.find("\"mass_matrices\"")) +
         R"("rods": [{"between": ["A", "B"], "mass": 6}]})";
}

TEST(MassMatrix, IsTheRodThatItSays) {
  for (const char* hold :
       {"", R"(, "fixed": true)", R"(, "driven": {"y": {"polynomial": [1, 2, 3]}})"}) {
    const SceneData matrix = parse_scene(rod(hold), "test");
    const SceneData same = parse_scene(as_rod(rod(hold)), "test");
    ASSERT_EQ(matrix.model.mass.size(), same.model.mass.size()) << hold;
    for (std::size_t i = 0; i < same.model.mass.size(); ++i) {
      EXPECT_EQ(matrix.model.mass[i].row, same.model.mass[i].row);
      EXPECT_EQ(matrix.model.mass[i].col, same.model.mass[i].col);
      EXPECT_DOUBLE_EQ(matrix.model.mass[i].value, same.model.mass[i].value);
    }
    EXPECT_EQ(matrix.model.force, same.model.force) << hold;
    ASSERT_EQ(matrix.model.driven_mass.size(), same.model.driven_mass.size());
    for (std::size_t i = 0; i < same.model.driven_mass.size(); ++i) {
      EXPECT_EQ(matrix.model.driven_mass[i].value, same.model.driven_mass[i].value);
    }
  }
}

TEST(MassMatrix, MayCoupleAxes) {
  const SceneData data =
      parse_scene(rod("", "[[2], [0, 2], [1, -0.5, 2], [0.5, 1, 0, 2]]"), "test");
  double found = 0.0;
  for (const MassEntry& entry : data.model.mass) {
    if (entry.row == 3 && entry.col == 0) found = entry.value;
    if (entry.row == 2 && entry.col == 1) {
      EXPECT_EQ(entry.value, -0.5);
    }
  }
  EXPECT_EQ(found, 0.5);
}

TEST(MassMatrix, RefusesWhatIsNone) {
  const auto expect = [](const std::string& scene, const std::vector<std::string>& parts) {
    expect_parts(parse_error_of(scene), parts);
  };
  expect(rod("", "[[2], [0, 2]]"), {"mass_matrices[0].matrix: found an array of 2", "of 4 rows"});
  expect(rod("", "[[2], [0, 2], [1, 0], [0, 1, 0, 2]]"),
         {"mass_matrices[0].matrix[2]", "an array of 3 numbers"});
  expect(rod("", "[[2], [0, 2], [3, 0, 2], [0, 1, 0, 2]]"), {"positive definite"});
  expect(rod("", "[[2], [0, 2], [1, 0, 2], [0, 1, 0, -2]]"), {"positive definite"});
  expect(rod("", "[[2], [0, 2], [1, 0, 2], [0, 1, 0, 2]]", R"(["A", "A"])"),
         {"mass_matrices[0].points[1]", "\"A\" twice", "different points"});
  expect(rod("", "[]", "[]"), {"no free point"});
  expect(rod(R"(, "fixed": true)", "[[1], [0, 1]]", R"(["A"])"), {"no free point"});
}

}  // namespace
}  // namespace mbs
