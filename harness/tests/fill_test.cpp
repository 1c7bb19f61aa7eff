// Artificial fill: how much, where, and that the choice is fair and reproducible.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "model_math/kinematics.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

using Positions = std::set<std::pair<int, int>>;  // row > col

/// The tangent's pattern below the diagonal, by definition: slow and obvious.
Positions tangent_positions(const Model& model) {
  Positions positions;
  for (const MassEntry& entry : model.mass()) {
    if (entry.row > entry.col) positions.emplace(entry.row, entry.col);
  }
  const auto entries = jacobian(model, 0.0, model.initial_position());
  for (const JacobianEntry& x : entries) {
    for (const JacobianEntry& y : entries) {
      if (x.row == y.row && x.col > y.col) positions.emplace(x.col, y.col);
    }
  }
  return positions;
}

Positions stored_zeros(const Model& model) {
  Positions positions;
  for (const MassEntry& entry : model.mass()) {
    if (entry.value == 0.0) positions.emplace(entry.row, entry.col);
  }
  return positions;
}

TEST(TangentNonzeros, AgreesWithTheDefinition) {
  for (const int loops : {1, 2, 7, 20}) {
    const Model model(four_bar(loops));
    EXPECT_EQ(tangent_nonzeros(model),
              model.variables() + 2 * static_cast<long>(tangent_positions(model).size()));
    EXPECT_EQ(tangent_nonzeros(model), 4 * (loops + 1) + 8 * loops);
  }
}

TEST(TangentNonzeros, SeesLinearAndDotConstraints) {
  const Model model(parse_scene(R"({"dimension": 3, "points": [
      {"name": "A", "position": [0, 0, 0], "fixed": true}, {"name": "B", "position": [1, 0, 0]},
      {"name": "C", "position": [1, 1, 0]}, {"name": "D", "position": [5, 1, 0]}],
      "masses": [{"point": "B", "mass": 1}, {"point": "C", "mass": 1}, {"point": "D", "mass": 1}],
      "constraints": [{"type": "dot", "first": ["A", "B"], "second": ["B", "C"]},
      {"type": "linear", "terms": [{"point": "D", "axis": "x", "coefficient": 1},
                                   {"point": "C", "axis": "z", "coefficient": 2}]}]})",
                                "test")
                        .model);
  EXPECT_EQ(tangent_nonzeros(model), 6 * 6 + 3 + 2);
  EXPECT_EQ(tangent_nonzeros(model),
            model.variables() + 2 * static_cast<long>(tangent_positions(model).size()));
}

TEST(TangentNonzeros, SeesSpringsAndBilinearConstraints) {
  ModelData data;
  for (int i = 0; i < 6; ++i) {
    data.points.push_back({"P" + std::to_string(i), i < 5 ? 2 * i : -1, {1.0 * i, 0.1 * i * i, 0}});
  }
  for (int i = 0; i < 10; ++i) data.mass.push_back({i, i, 1.0});
  data.force.resize(10, 0.0);
  data.initial_velocity.resize(10, 0.0);
  const auto extra = [&](const ModelData& changed) {
    return (tangent_nonzeros(Model(changed)) - 10) / 2;
  };
  EXPECT_EQ(extra(data), 0);
  ModelData spring = data;
  spring.springs.push_back({0, 1, 1.0, 0.0, 1.0, "s"});  // x and y of both: 4 of 4 coordinates
  EXPECT_EQ(extra(spring), 6);
  spring.springs[0].b = 5;  // fixed
  EXPECT_EQ(extra(spring), 1);
  ModelData damper = data;
  damper.springs.push_back({0, 1, 0.0, 1.0, 1.0, "d"});
  EXPECT_EQ(extra(damper), 6);
  ModelData torsion = data;
  torsion.torsion_springs.push_back({0, 1, 2, 5, -1, 1.0, 0.0, 0.0, "t"});  // 6 coordinates
  EXPECT_EQ(extra(torsion), 15);
  ModelData bilinear = data;
  bilinear.bilinear_constraints.push_back({0, 1, 2, 3, {{{0, 1, 0}, {-1, 0, 0}, {}}}, 0.0, "b"});
  EXPECT_EQ(extra(bilinear), 28);
  ModelData couple = data;
  couple.couples.push_back({0, 1, -1, 2.0, "c"});  // its derivative stays out of K
  EXPECT_EQ(extra(couple), 0);
}

TEST(TangentNonzeros, IsQuickForLargeSparseModels) {
  const Model model(four_bar(9'999));  // n = 20 000
  EXPECT_EQ(tangent_nonzeros(model), 4 * 10'000 + 8 * 9'999);
}

TEST(Fill, ReachesWhatIsAskedToWithinAPair) {
  for (const int loops : {1, 5, 40}) {
    for (const double asked : {0.3, 0.5, 0.77, 0.999, 1.0}) {
      ModelData data = four_bar(loops);
      const Model natural(data);
      const double positions = static_cast<double>(natural.variables()) * natural.variables();
      if (asked * positions < static_cast<double>(tangent_nonzeros(natural))) continue;
      const Fill fill = add_fill(data, asked, 1);
      const Model filled(data);
      EXPECT_EQ(fill.asked, asked);
      EXPECT_EQ(fill.seed, 1u);
      EXPECT_EQ(fill.natural, static_cast<double>(tangent_nonzeros(natural)) / positions);
      EXPECT_EQ(fill.reached, static_cast<double>(tangent_nonzeros(filled)) / positions);
      EXPECT_LE(std::abs(fill.reached - asked) * positions, 1.0);
    }
  }
}

TEST(Fill, AddsOnlyZerosAtAbsentPositions) {
  ModelData data = four_bar(9);
  const Model natural(data);
  const std::vector<MassEntry> before = data.mass;
  add_fill(data, 0.6, 7);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(data.mass[i].value, before[i].value);
  const Model filled(data);
  const Positions present = tangent_positions(natural);
  const Positions zeros = stored_zeros(filled);
  EXPECT_EQ(zeros.size(), data.mass.size() - before.size());
  for (const auto& position : zeros) {
    EXPECT_FALSE(present.contains(position));
    EXPECT_GT(position.first, position.second);
  }
  EXPECT_EQ(tangent_positions(filled).size(), present.size() + zeros.size());
}

TEST(Fill, DependsOnTheSeedAlone) {
  ModelData x = four_bar(9);
  ModelData y = four_bar(9);
  ModelData z = four_bar(9);
  add_fill(x, 0.6, 7);
  add_fill(y, 0.6, 7);
  add_fill(z, 0.6, 8);
  EXPECT_EQ(stored_zeros(Model(x)), stored_zeros(Model(y)));
  EXPECT_NE(stored_zeros(Model(x)), stored_zeros(Model(z)));
}

TEST(Fill, IsTheSameOnEveryPlatform) {
  ModelData data = four_bar(3);  // n = 8
  add_fill(data, 0.7, kFillSeed);
  EXPECT_EQ(stored_zeros(Model(data)), (Positions{{4, 0}, {7, 3}}));
}

/// Each absent pair must be drawn equally often: chi-squared over many seeds.
void expect_fair(double asked) {
  const ModelData data = four_bar(5);  // n = 12, 46 absent pairs
  const int absent = 12 * 11 / 2 - static_cast<int>(tangent_positions(Model(data)).size());
  constexpr int kSeeds = 800;
  std::map<std::pair<int, int>, int> drawn;
  int total = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    ModelData filled = data;
    add_fill(filled, asked, static_cast<std::uint64_t>(seed));
    for (const auto& position : stored_zeros(Model(filled))) {
      ++drawn[position];
      ++total;
    }
  }
  EXPECT_EQ(drawn.size(), static_cast<std::size_t>(absent));
  const double mean = static_cast<double>(total) / absent;
  double chi_squared = 0.0;
  for (const auto& [position, count] : drawn) chi_squared += (count - mean) * (count - mean) / mean;
  // Without replacement the counts vary less than Poisson: by 1 - share.
  chi_squared /= 1.0 - mean / kSeeds;
  EXPECT_NEAR(chi_squared, absent, 5.0 * std::sqrt(2.0 * absent));
}

TEST(Fill, ChoosesFairlyWhenFew) { expect_fair(0.5); }
TEST(Fill, ChoosesFairlyWhenMost) { expect_fair(0.9); }

TEST(Fill, RefusesWhatCannotBe) {
  for (const double asked : {0.0, -0.1, 1.0000001, std::nan(""), HUGE_VAL, 0.05}) {
    ModelData data = four_bar(5);
    EXPECT_THROW(add_fill(data, asked, 1), UsageError) << asked;
  }
  ModelData large = four_bar(5000);
  EXPECT_THROW(add_fill(large, 1.0, 1), UsageError);
}

TEST(Fill, FillsTwoThousandCoordinates) {
  ModelData data = four_bar(999);
  EXPECT_EQ(add_fill(data, 1.0, 1).reached, 1.0);
  // The lower triangle but for what constraints alone bring in: two points couple in 4 positions of
  // which M has 2, and x with y of one point in 1.
  EXPECT_EQ(data.mass.size(), 2000u * 2001u / 2u - 999u * 2u - 1000u);
}

}  // namespace
}  // namespace mbs
