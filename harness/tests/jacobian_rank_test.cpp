// Rank and dependent rows against dense singular values.
#include "model_math/jacobian_rank.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "scene/scene.hpp"

namespace mbs {
namespace {

int dense_rank(const Eigen::MatrixXd& matrix) {
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix);
  svd.setThreshold(1e-9);
  return static_cast<int>(svd.rank());
}

std::vector<JacobianEntry> entries_of(const Eigen::MatrixXd& matrix) {
  std::vector<JacobianEntry> entries;
  for (int row = 0; row < matrix.rows(); ++row) {
    for (int col = 0; col < matrix.cols(); ++col) {
      if (matrix(row, col) != 0.0) entries.push_back({row, col, matrix(row, col)});
    }
  }
  return entries;
}

/// Rows whose addition does not raise the rank, by definition.
std::vector<int> dependent_by_definition(const Eigen::MatrixXd& matrix) {
  std::vector<int> dependent;
  int rank = 0;
  for (int row = 0; row < matrix.rows(); ++row) {
    const int next = dense_rank(matrix.topRows(row + 1));
    if (next == rank) dependent.push_back(row);
    rank = next;
  }
  return dependent;
}

TEST(FindRank, AgreesWithSingularValues) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 500; ++trial) {
    const auto rows = static_cast<Eigen::Index>(1 + random() % 12);
    const auto cols = static_cast<Eigen::Index>(1 + random() % 12);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, cols);
    for (double& value : matrix.reshaped()) {
      if (random() % 3 == 0) value = normal(random);
    }
    for (std::uint64_t k = 0; k < random() % 4; ++k) {
      const auto a = static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(rows));
      const auto b = static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(rows));
      matrix.row(a) = (normal(random) * matrix.row(0) + matrix.row(b)).eval();
    }
    const auto found =
        find_rank(static_cast<int>(rows), static_cast<int>(cols), entries_of(matrix));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->rank, dense_rank(matrix)) << matrix;
    EXPECT_EQ(found->dependent, dependent_by_definition(matrix)) << matrix;
  }
}

TEST(FindRank, NamesTheLaterOfTwoEqualRows) {
  const JacobianEntry entries[] = {{0, 0, 1.0},  {0, 1, 2.0}, {1, 2, 1.0}, {2, 0, -3.0},
                                   {2, 1, -6.0}, {3, 1, 1.0}, {4, 0, 1.0}};
  const auto found = find_rank(5, 3, entries);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->rank, 3);
  EXPECT_EQ(found->dependent, (std::vector<int>{2, 4}));
}

TEST(FindRank, TakesEmptyMatricesAndRows) {
  EXPECT_EQ(find_rank(0, 4, {})->rank, 0);
  EXPECT_EQ(find_rank(2, 0, {})->dependent, (std::vector<int>{0, 1}));
  const JacobianEntry entries[] = {{1, 0, 1.0}, {2, 0, 0.0}};
  EXPECT_EQ(find_rank(3, 2, entries)->dependent, (std::vector<int>{0, 2}));
}

TEST(FindRank, RefusesNonFiniteValues) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
    const JacobianEntry entries[] = {{0, 0, 1.0}, {1, 1, bad}};
    EXPECT_THROW(find_rank(2, 2, entries), std::invalid_argument);
  }
}

TEST(FindRank, ManagesLongChains) {
  const int loops = 20'000;  // 40 002 coordinates
  const Model model(four_bar(loops));
  EXPECT_EQ(jacobian_rank(model, model.initial_position()), 2 * loops + 1);
  std::vector<double> flat;  // all rods on the x axis
  for (int i = 0; i <= loops; ++i) flat.insert(flat.end(), {i + 1.0, 0.0});
  EXPECT_EQ(jacobian_rank(model, flat), loops + 1);
}

}  // namespace
}  // namespace mbs
