// Table 2's operations: every variant that offers them gets them right; a wrong one is caught.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bench/operation_rows.hpp"
#include "model_math/kinematics.hpp"
#include "registry/registry.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "support/program.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

std::vector<double> somewhere(const Model& model) {
  const auto start = model.initial_position();
  std::vector<double> q(start.begin(), start.end());
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += 0.2 * std::sin(2.0 + static_cast<double>(i));
  return q;
}

/// Dense and slow; a test spoils one entry of one result.
class DenseOperations final : public Operations {
 public:
  using Spoil = std::function<void(int result, std::span<double> dense)>;
  DenseOperations(const Model& model, Spoil spoil) : model_(model), spoil_(std::move(spoil)) {}

  void set_coordinates(std::span<const double> q) override { q_.assign(q.begin(), q.end()); }
  void evaluate_jacobian() override {
    jacobian_.assign(static_cast<std::size_t>(model_.constraints()) * q_.size(), 0.0);
    for (const JacobianEntry& e : jacobian(model_, 0.0, q_)) {
      jacobian_[static_cast<std::size_t>(e.row) * q_.size() + static_cast<std::size_t>(e.col)] =
          e.value;
    }
  }
  void rank_update() override {
    const std::size_t n = q_.size();
    product_.assign(n * n, 0.0);
    for (std::size_t k = 0; k < jacobian_.size() / n; ++k) {
      for (std::size_t i = 0; i < n * n; ++i) {
        product_[i] += jacobian_[k * n + i / n] * jacobian_[k * n + i % n];
      }
    }
  }
  void add_mass(double factor) override {
    sum_ = product_;
    for (double& value : sum_) value *= factor;
    for (const MassEntry& e : model_.mass()) {
      const auto row = static_cast<std::size_t>(e.row), col = static_cast<std::size_t>(e.col);
      sum_[row * q_.size() + col] += e.value;
      if (row != col) sum_[col * q_.size() + row] += e.value;
    }
  }
  void get_jacobian(std::span<double> dense) const override { give(0, jacobian_, dense); }
  void get_rank_update(std::span<double> dense) const override { give(1, product_, dense); }
  void get_sum(std::span<double> dense) const override { give(2, sum_, dense); }

 private:
  void give(int result, const std::vector<double>& from, std::span<double> dense) const {
    std::ranges::copy(from, dense.begin());
    spoil_(result, dense);
  }

  const Model& model_;
  Spoil spoil_;
  std::vector<double> q_, jacobian_, product_, sum_;
};

TEST(CheckOperations, AcceptsRightAndNamesWrongResults) {
  const Scene scene = load_scene("four-bar:3,fill=0.8");
  const std::vector<double> q = somewhere(scene.model);
  DenseOperations right(scene.model, [](int, std::span<double>) {});
  EXPECT_EQ(check_operations(right, scene.model, q, 40.0), "");
  for (int wrong = 0; wrong < 3; ++wrong) {
    for (const double by : {1e-9, std::nan("")}) {
      DenseOperations spoiled(scene.model, [wrong, by](int result, std::span<double> dense) {
        if (result == wrong) dense[1] += by;
      });
      EXPECT_TRUE(check_operations(spoiled, scene.model, q, 40.0).starts_with(kOperations[wrong]))
          << by;
    }
  }
}

TEST(Operations, OfEveryVariantThatOffersThemAreRight) {
  int offered = 0;
  for (const NamedVariant& variant : all_variants()) {
    if (variant.variant->operations == nullptr) continue;
    ++offered;
    std::vector<Scene> scenes{test::free_fall(), test::spatial_pendulum()};
    for (const char* name :
         {"four-bar:1", "four-bar:6", "four-bar:5,fill=0.7", "four-bar:4,fill=1"}) {
      scenes.push_back(load_scene(name));
    }
    for (const Scene& scene : scenes) {
      SCOPED_TRACE(variant.name + " on " + scene.name);
      const auto operations = variant.variant->operations(scene.model);
      const auto start = scene.model.initial_position();
      for (const double factor : {1.0, 4000.0}) {
        EXPECT_EQ(check_operations(*operations, scene.model, somewhere(scene.model), factor), "");
        EXPECT_EQ(check_operations(*operations, scene.model, {start.begin(), start.end()}, factor),
                  "");
      }
    }
  }
  if (offered == 0) GTEST_SKIP() << "no available variant offers its operations";
}

/// Keeps what rows say of errors.
class ErrorReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) errors.push_back(run.error_message);
  }
  std::vector<std::string> errors;
};

TEST(OperationRows, WhoThrowsCostsTheOthersNothing) {
  const PlannedScene planned{load_scene("four-bar:1"), {}, {}};
  Variant variant;
  variant.operations = [](const Model&) -> std::unique_ptr<Operations> {
    throw std::runtime_error("a library's own words");
  };
  const std::vector<PlannedCell> cells{{"folder/throws/four-bar:1", &planned, &variant}};
  OperationRows rows;
  rows.add(cells);
  ErrorReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::ClearRegisteredBenchmarks();
  EXPECT_TRUE(rows.failed());
  EXPECT_EQ(reporter.errors, std::vector<std::string>(kOperations.size(), "error: a library's own words"));
}

TEST(BenchProgram, RefusesOperationsOfWhoOffersNone) {
  const auto run = test::run_mbs("bench four-bar:1 --operations --implementation eigen_dense");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("unsupported"), std::string::npos) << run.output;
}

TEST(BenchProgram, RefusesOperationsOnScenesThatTheVariantDoesNotServe) {
  const auto run = test::run_mbs("bench '" MBS_ROOT "/harness/scenes/examples/bump_stop.json'"
                                 " --operations --implementation ublas_sparse");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("unsupported: it does not serve force laws"), std::string::npos)
      << run.output;
}

}  // namespace
}  // namespace mbs
