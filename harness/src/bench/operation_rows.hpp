// Rows of Google Benchmark for the three operations of the paper's Table 2.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "bench/bench_plan.hpp"
#include "mbs/operations.hpp"

namespace mbs {

/// The names that end those of the rows, in the order in which one uses the result of the other.
inline constexpr std::array kOperations{"jacobian_evaluation", "rank_k_update", "matrix_addition"};

/// Sizes beyond this are refused: results are compared position by position in dense storage.
inline constexpr int kMostVariablesOfOperations = 2002;

/// What is wrong with the results of `operations` at the coordinates q, compared with the
/// harness's own Jacobian, products and sums position by position; empty if nothing is.
std::string check_operations(Operations& operations, const Model& model,
                             const std::vector<double>& q, double factor);

/// Registers "folder/variant/scene/<operation>" for each of kOperations: real time, microseconds,
/// one iteration being one call. The results are checked at two configurations first. A variant
/// that offers no operations, a scene that is too large, or a wrong result is a row with
/// error_occurred and "unsupported: ..." or "disagrees: ..."; what a variant throws one with a
/// CellFailure's text. Counters: variables, constraints, fill_percent.
class OperationRows {
 public:
  /// `cells` and what they point to must outlive the object, and the object the benchmarks' run.
  void add(const std::vector<PlannedCell>& cells);
  /// Whether a row that has run failed.
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  struct Subject {
    PlannedCell cell;
    std::unique_ptr<Operations> operations;
    std::string failure;
  };
  void prepare(Subject& subject);
  void run(Subject& subject, std::size_t operation, benchmark::State& state);

  std::deque<Subject> subjects_;
  Subject* live_ = nullptr;
  bool failed_ = false;
};

}  // namespace mbs
