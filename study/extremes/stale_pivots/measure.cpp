// Backward errors, re-pivotings and times of every strategy on a sequence of matrices.
#include "measure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <span>
#include <type_traits>

#include "csc_klu/solver.hpp"

namespace mbs::stale_pivots {
namespace {

/// A solver of any kind, with its rule.
class Contender {
 public:
  virtual ~Contender() = default;
  /// Replaces b by the solution; false if there is none.
  virtual bool solve(std::span<const double> values, std::span<double> b) = 0;
  [[nodiscard]] virtual int repivotings() const = 0;
};

template <TangentSolver Solver>
class Contending final : public Contender {
 public:
  template <class Rule>
  Contending(const Sequence& sequence, Rule rule)
      : solver_(sequence.pattern, sequence.matrices.front(),
                Structure{sequence.kind, sequence.order}, rule) {}

  bool solve(std::span<const double> values, std::span<double> b) override {
    ++matrices_;
    if (!solver_.factorize(values)) return false;
    solver_.solve(b);
    return true;
  }
  [[nodiscard]] int repivotings() const override {
    if constexpr (requires { solver_.repivotings(); }) return solver_.repivotings();
    return std::is_same_v<Solver, Factorization> ? matrices_ - 1 : 0;
  }

 private:
  Solver solver_;
  int matrices_ = 0;
};

/// A row to be, and what it comes from.
struct Entrant {
  std::string strategy, pivoting;
  double tolerance;
  std::unique_ptr<Contender> contender = {};
  std::vector<double> errors = {}, times = {};

  void start(const Sequence& sequence) {
    if (strategy == "refactor") {
      contender = std::make_unique<Contending<Refactorization>>(sequence, tolerance);
    } else if (strategy == "guarded") {
      contender = std::make_unique<Contending<GuardedRefactorization>>(sequence, Guard{tolerance});
    } else {
      contender = std::make_unique<Contending<Factorization>>(sequence, tolerance);
    }
  }
};

std::vector<Entrant> all_entrants() {
  std::vector<Entrant> entrants;
  const auto add = [&](const char* strategy, const char* pivoting, double tolerance) {
    entrants.push_back({strategy, pivoting, tolerance});
  };
  add("refactor", "diagonal", kDiagonalPivots);
  add("refactor", "default", kPivotTolerance);
  add("refactor", "largest", 1.0);
  add("guarded", "default", kPivotTolerance);
  add("guarded", "largest", 1.0);
  add("factor", "default", kPivotTolerance);
  add("factor", "largest", 1.0);
  return entrants;
}

double backward_error(const Pattern& pattern, std::span<const double> values,
                      std::span<const double> x, std::span<const double> b) {
  std::vector<double> residual(b.begin(), b.end()), size(b.size());
  for (std::size_t i = 0; i < b.size(); ++i) size[i] = std::abs(b[i]);
  for (int col = 0; col < pattern.columns(); ++col) {
    for (int k = pattern.column_begin[col]; k < pattern.column_begin[col + 1]; ++k) {
      residual[pattern.row[k]] -= values[k] * x[col];
      size[pattern.row[k]] += std::abs(values[k] * x[col]);
    }
  }
  double largest = 0.0;
  for (const double r : residual) {
    if (!std::isfinite(r)) return 1.0;
    largest = std::max(largest, std::abs(r));
  }
  return largest / *std::ranges::max_element(size);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// One solve, and what it took.
void run(Entrant& entrant, const Sequence& sequence, std::span<const double> values,
         std::span<const double> b, std::vector<double>& x) {
  std::ranges::copy(b, x.begin());
  const auto start = std::chrono::steady_clock::now();
  const bool solved = entrant.contender->solve(values, x);
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
  entrant.times.push_back(time.count());
  entrant.errors.push_back(solved ? backward_error(sequence.pattern, values, x, b) : 1.0);
}

}  // namespace

std::vector<Row> measure(const Sequence& sequence, int rounds) {
  std::vector<Entrant> entrants = all_entrants();
  std::vector<double> b(sequence.pattern.columns()), x(b.size());
  for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::sin(1.0 + 7.0 * i);
  for (int round = 0; round < rounds; ++round) {
    for (Entrant& entrant : entrants) entrant.start(sequence);
    for (std::size_t k = 0; k < sequence.matrices.size(); ++k) {
      for (std::size_t turn = 0; turn < entrants.size(); ++turn) {  // no one is always first
        run(entrants[(k + turn) % entrants.size()], sequence, sequence.matrices[k], b, x);
      }
    }
  }
  std::vector<Row> rows;
  for (const Entrant& entrant : entrants) {
    rows.push_back({sequence.name, sequence.form, entrant.strategy,
                    static_cast<int>(sequence.matrices.size()), entrant.pivoting,
                    median(entrant.errors), *std::ranges::max_element(entrant.errors),
                    entrant.contender->repivotings(), median(entrant.times)});
  }
  return rows;
}

}  // namespace mbs::stale_pivots
