// Counts of eliminations worked by hand, and random ones done entry by entry.
#include "describe/elimination.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// Row and column 0 are full.
SymmetricPattern arrow(int size) {
  Pairs pairs;
  for (int i = 1; i < size; ++i) pairs.emplace_back(i, 0);
  return {size, pairs};
}

SymmetricPattern band(int size, int width) {
  Pairs pairs;
  for (int j = 0; j < size; ++j) {
    for (int i = j + 1; i <= std::min(j + width, size - 1); ++i) pairs.emplace_back(i, j);
  }
  return {size, pairs};
}

void expect_counts(const SymmetricPattern& pattern, const std::vector<int>& order, long nonzeros,
                   double flops, int height, int widest, int supernodes) {
  const auto found = eliminate(pattern, order);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->factor_nonzeros, nonzeros);
  EXPECT_EQ(found->flops, flops);
  EXPECT_EQ(found->height, height);
  EXPECT_EQ(found->widest, widest);
  EXPECT_EQ(found->supernodes, supernodes);
}

TEST(Elimination, ArrowFillsUpAsGivenAndNotByMinimumDegree) {
  const auto small = arrow(5);
  expect_counts(small, natural_order(small), 5 + 4 + 3 + 2 + 1, 25 + 16 + 9 + 4 + 1, 5, 5, 1);
  for (const int size : {5, 40}) {  // Eigen's AMD puts the hub of the small one aside as dense
    const auto pattern = arrow(size);
    expect_counts(pattern, amd_order(pattern), 2 * size - 1, 4.0 * (size - 1) + 1.0, 2, 2,
                  size - 1);
  }
}

TEST(Elimination, BandKeepsItsWidth) {
  const auto three = band(6, 1), five = band(6, 2);
  expect_counts(three, natural_order(three), 11, 5 * 4 + 1, 6, 2, 5);
  expect_counts(five, natural_order(five), 3 * 4 + 2 + 1, 9 * 4 + 4 + 1, 6, 3, 4);
  // From both ends to the middle the tree has two branches.
  expect_counts(band(5, 1), {0, 4, 1, 3, 2}, 9, 4 * 4 + 1, 3, 2, 4);
}

TEST(Elimination, DiagonalAndFullAndSmall) {
  const auto diagonal = band(4, 0), full = band(7, 6), one = band(1, 0), none = band(0, 0);
  expect_counts(diagonal, amd_order(diagonal), 4, 4, 1, 1, 4);
  expect_counts(full, amd_order(full), 28, 140, 7, 7, 1);
  expect_counts(one, amd_order(one), 1, 1, 1, 1, 1);
  expect_counts(none, natural_order(none), 0, 0, 0, 0, 0);
}

TEST(Elimination, ColumnsOfABandAreOrderedSoThatLittleFills) {
  const auto pattern = band(40, 1);
  const auto found = eliminate(pattern, colamd_order(pattern));
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(found->factor_nonzeros, 3 * 40);  // a random order leaves far more
  EXPECT_TRUE(colamd_order(band(0, 0)).empty());
}

TEST(Elimination, NestedDissectionOfAGridLeavesLessThanItsRows) {
  constexpr int kSide = 24;
  Pairs pairs;
  for (int i = 0; i < kSide * kSide; ++i) {
    if (i % kSide + 1 < kSide) pairs.emplace_back(i + 1, i);
    if (i + kSide < kSide * kSide) pairs.emplace_back(i + kSide, i);
  }
  const SymmetricPattern grid(kSide * kSide, pairs);
  std::vector<int> order = metis_order(grid);
  const auto found = eliminate(grid, order), natural = eliminate(grid, natural_order(grid));
  ASSERT_TRUE(found && natural);
  EXPECT_LT(2 * found->factor_nonzeros, natural->factor_nonzeros);
  std::ranges::sort(order);
  EXPECT_EQ(order, natural_order(grid));
  EXPECT_EQ(metis_order(band(4, 0)), natural_order(band(4, 0)));
  EXPECT_TRUE(metis_order(band(0, 0)).empty());
}

TEST(Elimination, ALoopFills) {
  const SymmetricPattern loop(4, {{1, 0}, {2, 1}, {3, 2}, {3, 0}});
  expect_counts(loop, natural_order(loop), 3 + 3 + 2 + 1, 9 + 9 + 4 + 1, 4, 3, 2);
}

TEST(Elimination, RandomPatternsAsEntryByEntry) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const int size = 1 + static_cast<int>(random() % 15);
    std::vector<int> order(static_cast<std::size_t>(size));
    std::vector<std::vector<char>> full(order.size(), std::vector<char>(order.size(), false));
    Pairs pairs;
    for (int j = 0; j < size; ++j) {
      for (int i = j + 1; i < size; ++i) {
        if (random() % 4 == 0) pairs.emplace_back(i, j);
      }
    }
    const SymmetricPattern pattern(size, pairs);
    order = trial % 4 == 0 ? amd_order(pattern) : trial % 4 == 2 ? colamd_order(pattern) : natural_order(pattern);
    if (trial % 3 == 0) std::ranges::shuffle(order, random);
    std::vector<int> sorted = order;
    std::ranges::sort(sorted);
    ASSERT_EQ(sorted, natural_order(pattern));  // a permutation

    std::vector<int> place(order.size());
    for (int k = 0; k < size; ++k) place[order[k]] = k;
    for (const auto& [i, j] : pairs) full[place[i]][place[j]] = full[place[j]][place[i]] = true;
    long nonzeros = 0;
    double flops = 0.0;
    int tallest = 0, widest = 0;
    std::vector<int> height(order.size(), 1), counts;
    std::set<int> goes_on;  // columns with the rows of one before, less one
    std::vector<std::pair<int, int>> parents;
    for (int k = 0; k < size; ++k) {
      std::vector<int> below;
      for (int i = k + 1; i < size; ++i) {
        if (full[i][k]) below.push_back(i);
      }
      for (const int i : below) {
        for (const int j : below) full[i][j] = true;
      }
      const int count = static_cast<int>(below.size()) + 1;
      nonzeros += count;
      flops += count * count;
      widest = std::max(widest, count);
      tallest = std::max(tallest, height[k]);
      if (!below.empty()) height[below[0]] = std::max(height[below[0]], height[k] + 1);
      if (!below.empty()) parents.emplace_back(k, below[0]);
      counts.push_back(count);
    }
    for (const auto& [child, parent] : parents) {
      if (counts[child] == counts[parent] + 1) goes_on.insert(parent);
    }
    expect_counts(pattern, order, nonzeros, flops, tallest, widest,
                  size - static_cast<int>(goes_on.size()));
  }
}

using Lists = std::vector<std::vector<int>>;

TEST(Elimination, RowsOfConstraintsWaitForTheirVariables) {
  // Variables 0 to 2; row 3 has 0 and 2, row 4 has 1, row 5 none.
  const SymmetricPattern pattern(6, {{3, 0}, {3, 2}, {4, 1}});
  EXPECT_EQ(rows_behind({2, 1, 0}, pattern, {{}, {}, {}}), (std::vector<int>{5, 2, 1, 4, 0, 3}));
  const auto pendulum = saddle_point_pattern(load_scene("chain:1").model);  // x, y and its rod
  expect_counts(pendulum, rows_behind({0, 1}, pendulum, {{}}), 2 + 2 + 1, 4 + 4 + 1, 2, 2, 2);
}

TEST(Elimination, ASubstitutionComesRightAfterItsVariable) {
  // Variables 0 to 2; row 3 has 0 and 2 and owns 0, row 4 has 0 and 1 and waits for 2, too.
  const SymmetricPattern pattern(5, {{3, 0}, {3, 2}, {4, 0}, {4, 1}});
  EXPECT_EQ(rows_behind({0, 1, 2}, pattern, {{0}, {}}), (std::vector<int>{0, 3, 1, 2, 4}));
  EXPECT_EQ(rows_behind({0, 1, 2}, pattern, {{}, {}}), (std::vector<int>{0, 1, 4, 2, 3}));
}

TEST(Elimination, LinearConstraintsOwnWhatNoOtherHas) {
  ModelData data;
  data.points = {{"A", 0, {1.0, 0.0}}, {"B", 2, {0.0, 1.0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}, {2, 2, 1.0}, {3, 3, 1.0}};
  data.force = data.initial_velocity = {0.0, 0.0, 0.0, 0.0};
  data.linear_constraints = {{.terms = {{0, 1.0}, {1, -2.0}}, .value = 1.0, .name = "largest"},
                             {.terms = {{2, 1e-4}, {3, 1.0}}, .value = 1.0, .name = "far below"},
                             {.terms = {{3, 1.0}}, .value = 1.0, .name = "nothing of its own"}};
  EXPECT_EQ(owned_coordinates(Model(data)), (Lists{{1}, {}, {}}));
}

TEST(Elimination, ADistanceOwnsAPointThatNoOtherConstraintHas) {
  ModelData data;
  data.points = {{"A", 0, {1.0, 0.0}}, {"B", 2, {2.0, 0.0}}, {"C", 4, {3.0, 0.0}}};
  data.force = data.initial_velocity = std::vector<double>(6, 0.0);
  for (int i = 0; i < 6; ++i) data.mass.push_back({i, i, 1.0});
  data.dot_constraints = {{0, 1, 0, 1, 1.0, "AB"}, {1, 2, 1, 2, 1.0, "BC"}};
  EXPECT_EQ(owned_coordinates(Model(data)), (Lists{{0, 1}, {4, 5}}));
  data.mass[0].value = data.mass[1].value = 1e4;  // B, which is light, would lean on A
  EXPECT_EQ(owned_coordinates(Model(data)), (Lists{{}, {4, 5}}));
  data.linear_constraints = {{.terms = {{5, 1.0}}, .value = 0.0, .name = "C"}};
  EXPECT_EQ(owned_coordinates(Model(data)), (Lists{{}, {}, {5}}));
}

TEST(Elimination, ManyBladesOnARotorFillNoMoreThanFew) {
  const auto per_column = [](const char* name) {
    const Model model = load_scene(name).model;
    const SymmetricPattern pattern = saddle_point_pattern(model);
    return eliminate(pattern, rows_behind(amd_order(tangent_pattern(model)), pattern,
                                          owned_coordinates(model)))->per_column;
  };
  EXPECT_LT(per_column("star:200"), 1.5 * per_column("star:20"));
  EXPECT_LT(per_column("vehicle:200"), 1.5 * per_column("vehicle:20"));
}

TEST(Elimination, TooManyAreNotCounted) {
  const auto pattern = arrow(10'001);
  EXPECT_EQ(eliminate(pattern, natural_order(pattern)), std::nullopt);
  const auto json = elimination_json(pattern, pattern, {});
  EXPECT_TRUE(json["orderings"]["natural"].is_null());
  EXPECT_EQ(json["factor_nonzeros"], 2 * 10'001 - 1);
  EXPECT_EQ(json["widest"], 2);
}

}  // namespace
}  // namespace mbs
