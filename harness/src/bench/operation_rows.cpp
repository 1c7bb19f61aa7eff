// Checks the operations against dense sums in extended precision, then times them one by one.
#include "bench/operation_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model_math/kinematics.hpp"
#include "registry/factory.hpp"

namespace mbs {
namespace {

using Dense = std::vector<double>;

/// Phi_q, Phi_q^T Phi_q and M + factor Phi_q^T Phi_q, row by row.
struct Expected {
  Dense jacobian, rank_update, sum;
};

Expected expect(const Model& model, const std::vector<double>& q, double factor) {
  const std::size_t n = q.size(), m = static_cast<std::size_t>(model.constraints());
  Expected expected{Dense(m * n), Dense(n * n), Dense(n * n)};
  std::vector<long double> products(n * n, 0.0L);
  const std::vector<JacobianEntry> entries = jacobian(model, 0.0, q);
  const auto at = [n](int row, int col) {
    return static_cast<std::size_t>(row) * n + static_cast<std::size_t>(col);
  };
  for (auto begin = entries.begin(); begin != entries.end();) {
    const auto end = std::find_if(begin, entries.end(),
                                  [&](const JacobianEntry& e) { return e.row != begin->row; });
    for (auto left = begin; left != end; ++left) {
      expected.jacobian[at(left->row, left->col)] = left->value;
      for (auto right = begin; right != end; ++right) {
        products[at(left->col, right->col)] += static_cast<long double>(left->value) * right->value;
      }
    }
    begin = end;
  }
  std::ranges::transform(products, expected.rank_update.begin(),
                         [](long double value) { return static_cast<double>(value); });
  std::ranges::transform(products, expected.sum.begin(), [factor](long double value) {
    return static_cast<double>(factor * value);
  });
  for (const MassEntry& entry : model.mass()) {
    expected.sum[at(entry.row, entry.col)] += entry.value;
    if (entry.row != entry.col) expected.sum[at(entry.col, entry.row)] += entry.value;
  }
  return expected;
}

/// What the rank-k update is multiplied by in Eq. (5).
double eq5_factor(const StepSettings& settings) {
  return settings.penalty * settings.step * settings.step / 4;
}

/// "<name>: ..." about the first position that differs by more than rounding, else empty.
std::string compare(const char* name, const Dense& found, const Dense& expected, std::size_t n) {
  constexpr double kRounding = 1e-13;
  double scale = 0.0;
  for (const double value : expected) scale = std::max(scale, std::abs(value));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    // Written so that a NaN differs.
    if (std::abs(found[i] - expected[i]) <= kRounding * scale) continue;
    return fmt::format("{}: entry ({}, {}) is {:.17g}, expected {:.17g}", name, i / n, i % n,
                       found[i], expected[i]);
  }
  return "";
}

}  // namespace

std::string check_operations(Operations& operations, const Model& model,
                             const std::vector<double>& q, double factor) {
  const std::size_t n = q.size();
  const Expected expected = expect(model, q, factor);
  Dense found(expected.jacobian.size(), std::nan(""));
  operations.set_coordinates(q);
  operations.evaluate_jacobian();
  operations.get_jacobian(found);
  std::string wrong = compare(kOperations[0], found, expected.jacobian, n);
  if (!wrong.empty()) return wrong;
  found.assign(n * n, std::nan(""));
  operations.rank_update();
  operations.get_rank_update(found);
  wrong = compare(kOperations[1], found, expected.rank_update, n);
  if (!wrong.empty()) return wrong;
  found.assign(n * n, std::nan(""));
  operations.add_mass(factor);
  operations.get_sum(found);
  return compare(kOperations[2], found, expected.sum, n);
}

void OperationRows::add(const std::vector<PlannedCell>& cells) {
  for (const PlannedCell& cell : cells) {
    Subject& subject = subjects_.emplace_back(Subject{cell, nullptr, ""});
    for (std::size_t operation = 0; operation < kOperations.size(); ++operation) {
      const std::string name = cell.name + "/" + kOperations[operation];
      benchmark::RegisterBenchmark(name.c_str(), [this, &subject,
                                                  operation](benchmark::State& state) {
        run(subject, operation, state);
      })->Unit(benchmark::kMicrosecond);
    }
  }
}

void OperationRows::prepare(Subject& subject) {
  if (live_ == &subject) return;
  if (live_ != nullptr) live_->operations.reset();  // big ones do not add up in memory
  live_ = &subject;
  const Model& model = subject.cell.scene->scene.model;
  if (subject.cell.variant->operations == nullptr) {
    subject.failure = "unsupported: this variant does not offer its operations one by one";
    return;
  }
  if (model.variables() > kMostVariablesOfOperations) {
    subject.failure = fmt::format("unsupported: results of more than {} variables are not checked",
                                  kMostVariablesOfOperations);
    return;
  }
  try {
    subject.operations = create_operations(*subject.cell.variant, model);
    const StepSettings& settings = subject.cell.scene->settings;
    const double factor = eq5_factor(settings);
    const auto start = model.initial_position();
    // Two configurations, the first once more at the end: the second must leave nothing behind.
    const std::vector<double> first(start.begin(), start.end());
    std::vector<double> second = first;
    for (std::size_t i = 0; i < second.size(); ++i) second[i] += 0.1 * std::cos(1.0 + i);
    for (const auto& q : {first, second, first}) {
      const std::string wrong = check_operations(*subject.operations, model, q, factor);
      if (!wrong.empty()) subject.failure = "disagrees: " + wrong;
    }
    subject.operations->set_coordinates(second);
  } catch (...) {
    subject.failure = failure_text();
  }
}

void OperationRows::run(Subject& subject, std::size_t operation, benchmark::State& state) {
  prepare(subject);
  if (!subject.failure.empty()) {
    failed_ = true;
    state.SkipWithError(subject.failure.c_str());
    return;
  }
  Operations& operations = *subject.operations;
  const PlannedScene& planned = *subject.cell.scene;
  // What this one works on comes from the one before.
  operations.evaluate_jacobian();
  operations.rank_update();
  static_assert(kOperations.size() == 3, "a case for each");
  switch (operation) {
    case 0:
      for (auto iteration : state) (void)iteration, operations.evaluate_jacobian();
      break;
    case 1:
      for (auto iteration : state) (void)iteration, operations.rank_update();
      break;
    case 2:
      for (auto iteration : state)
        (void)iteration, operations.add_mass(eq5_factor(planned.settings));
      break;
  }
  state.counters["variables"] = planned.scene.model.variables();
  state.counters["constraints"] = planned.scene.model.constraints();
  state.counters["fill_percent"] = planned.fill_percent;
}

}  // namespace mbs
