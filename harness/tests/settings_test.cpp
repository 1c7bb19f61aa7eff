// The automatic rules for penalty and tolerance against their documented formulas, and bad values.
#include "run/settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/scene.hpp"
#include "support/dense.hpp"
#include "support/sample_models.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

constexpr double kStep = 1.25e-3;

struct Spectrum {
  double smallest, mean;  ///< s_min and s_mean of automatic_penalty()
};

Spectrum spectrum_of(const Model& model) {
  const Eigen::MatrixXd Phi_q = test::dense_jacobian(model, model.initial_position());
  const Eigen::MatrixXd M = test::dense_mass(model);
  const Eigen::MatrixXd S = Phi_q * M.llt().solve(Eigen::MatrixXd(Phi_q.transpose()));
  const Eigen::MatrixXd lumped = M.diagonal().asDiagonal().inverse();
  return {Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S).eigenvalues()[0],
          (Phi_q * lumped * Phi_q.transpose()).trace() / static_cast<double>(Phi_q.rows())};
}

TEST(AutomaticPenalty, IsTheDocumentedRule) {
  bool lower = false, middle = false;
  for (const int loops : {1, 10, 40, 60}) {
    const Model model(four_bar(loops));
    const Spectrum s = spectrum_of(model);
    for (const double step : {1e-3, kStep, 1e-2}) {
      const double rule =
          4 / (step * step) * std::clamp(30 / s.smallest, 4e3 / s.mean, 1e7 / s.mean);
      EXPECT_NEAR(automatic_penalty(model, step), rule, 0.05 * rule) << loops;
    }
    (30 / s.smallest > 4e3 / s.mean ? middle : lower) = true;
  }
  EXPECT_TRUE(lower && middle);  // both parts of the rule were met
}

TEST(AutomaticPenalty, IsBoundedWhereConstraintsAreRedundant) {
  ModelData data = four_bar(2);
  data.dot_constraints.push_back(data.dot_constraints[0]);
  const Model model(std::move(data));
  const double bound = 4 / (kStep * kStep) * 1e7 / spectrum_of(model).mean;
  EXPECT_NEAR(automatic_penalty(model, kStep), bound, 1e-6 * bound);
}

TEST(AutomaticPenalty, IsOneWithoutConstraints) {
  EXPECT_EQ(automatic_penalty(test::free_fall().model, kStep), 1.0);
}

TEST(AutomaticTolerance, IsTheDocumentedRule) {
  const Model model(four_bar(10));
  const double penalty = automatic_penalty(model, kStep);
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, kStep, penalty), 1e-9);
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, 2 * kStep, penalty / 4), 16e-9);
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, 1.0, 1.0), 1e-6);
  const double unit = std::ldexp(1.0, -53), step = 1e-5, alpha = 1e12;
  const double noise =
      10 * unit * 10.0 * std::sqrt(1 + alpha * step * step / 4 * spectrum_of(model).mean);
  EXPECT_GT(noise, 1e-9 * std::pow(step / kStep, 4));
  EXPECT_NEAR(automatic_tolerance(model, step, alpha), noise, 1e-9 * noise);
}

TEST(AutomaticTolerance, WithoutConstraints) {
  EXPECT_DOUBLE_EQ(automatic_tolerance(test::free_fall().model, kStep, 1.0), 1e-9);
}

TEST(ParsePenalty, TakesNumbersAndAuto) {
  const Model model(four_bar(2));
  EXPECT_EQ(parse_penalty("1e8", model, kStep), 1e8);
  EXPECT_EQ(parse_penalty("0.5", model, kStep), 0.5);
  EXPECT_EQ(parse_penalty("123456", model, kStep), 123456.0);
  EXPECT_EQ(parse_penalty("auto", model, kStep), automatic_penalty(model, kStep));
}

TEST(ParsePenalty, RefusesEverythingElse) {
  const Model model(four_bar(2));
  for (const char* text :
       {"",     " ",     "auto ",  "Auto", "0",    "-0",   "-1",  "nan",  "-nan", "inf",
        "-inf", "1e400", "1e-400", "1e8x", " 1e8", "1e8 ", "1,5", "0x10", "--",   "e8"}) {
    try {
      parse_penalty(text, model, kStep);
      ADD_FAILURE() << '"' << text << "\" was taken";
    } catch (const UsageError& error) {
      expect_parts(error.what(), {"--penalty", std::string("'") + text + "'", "'auto'", "above 0"});
    }
  }
}

}  // namespace
}  // namespace mbs
