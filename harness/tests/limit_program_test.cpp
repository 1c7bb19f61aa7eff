// `mbs limit` and the name "limit" in the other subcommands, as a user meets them.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/program.hpp"

namespace mbs {
namespace {

TEST(LimitProgram, GivesBoundsAndTheMeasuredStep) {
  const auto run = test::run_mbs("limit 1 4 --json");
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto all = nlohmann::json::parse(run.output);
  const auto& rows = all.at("rows");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].at("variables"), 4);
  EXPECT_EQ(rows[1].at("loops"), 4);
  for (const auto& row : rows) {
    const auto number = [&row](const char* key) { return row.at(key).get<double>(); };
    const double largest =
        std::max({number("arithmetic_ns"), number("latency_ns"), number("memory_ns")});
    EXPECT_EQ(number("bound_ns"), largest);
    EXPECT_GT(std::min({number("arithmetic_ns"), number("latency_ns"), number("memory_ns")}), 0.0);
    EXPECT_NEAR(number("ratio"), number("measured_ns") / largest, 1e-9 * number("ratio"));
    EXPECT_GE(number("passes"), 1.0);
    const double flops = number("additions") + number("multiplications") + number("divisions");
    EXPECT_NEAR(number("flops"), flops + 2 * number("fused"), 1e-6);
  }
  EXPECT_EQ(all.at("machine").at("levels").size(), 4U);
}

TEST(LimitProgram, PrintsATable) {
  const auto run = test::run_mbs("limit 2");
  EXPECT_EQ(run.status, 0) << run.errors;
  for (const char* word : {"flops/ns", "arithmetic", "latency", "memory", "ratio"}) {
    EXPECT_NE(run.output.find(word), std::string::npos) << word;
  }
}

TEST(LimitProgram, RefusesWhatIsNoNumberOfLoops) {
  for (const char* loops : {"0", "-1", "x", "100001"}) {
    const auto run = test::run_mbs(std::string("limit ") + loops);
    EXPECT_EQ(run.status, 2) << loops;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
  }
}

TEST(LimitProgram, IsListedApart) {
  const auto listed = nlohmann::json::parse(test::run_mbs("list --json").output);
  EXPECT_EQ(listed.at("reference_line").at("name"), "limit/limit");
  for (const auto& entry : listed.at("implementations")) EXPECT_NE(entry.at("folder"), "limit");
  const std::string text = test::run_mbs("list").output;
  const auto heading = text.find("Reference line, only if named:\n");
  ASSERT_NE(heading, std::string::npos);
  EXPECT_GT(text.find("limit/limit"), heading);
}

TEST(LimitProgram, RunsWhereImplementationsDo) {
  const auto simulated =
      test::run_mbs("simulate four-bar:3 --implementation limit --duration 0.5 --json");
  EXPECT_EQ(simulated.status, 0) << simulated.errors;
  const auto summary = nlohmann::json::parse(simulated.output);
  EXPECT_EQ(summary.at("status"), "ok");
  EXPECT_EQ(summary.at("implementation"), "limit/limit");
  const auto timed =
      test::run_mbs("bench four-bar:3 --implementation limit --steps 50 --benchmark_min_time=0");
  EXPECT_EQ(timed.status, 0) << timed.errors;
  EXPECT_NE(timed.output.find("\nlimit/limit "), std::string::npos);
  EXPECT_EQ(timed.output.find("null/null"), std::string::npos);
  const auto refused = test::run_mbs("check four-bar:3,fill=0.9 --implementation limit");
  EXPECT_NE(refused.output.find("unsupported: it is written for the N-four-bar mechanism alone"),
            std::string::npos);
}

}  // namespace
}  // namespace mbs
