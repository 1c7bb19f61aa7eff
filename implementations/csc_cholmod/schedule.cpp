// Walks over rows and pairs of their entries.
#include "schedule.hpp"

#include <numeric>

namespace mbs::csc_cholmod {
namespace {

/// Visits each pair of entries of a linear row once: (row, column, product of coefficients).
template <typename Visit>
void for_linear_pairs(const LinearBlock& linear, Visit visit) {
  for (int k = 0; k < linear.count; ++k) {
    for (int s = linear.start[k]; s < linear.start[k + 1]; ++s) {
      for (int t = s; t < linear.start[k + 1]; ++t) {
        visit(linear.column[s], linear.column[t], linear.coefficient[s] * linear.coefficient[t]);
      }
    }
  }
}

/// Products of two entries of a row of `rows`; `first` is the number of the first product.
template <typename Lowered>
void add_products(const Lowered& lowered, const SignedRows& rows, int first,
                  const HalfPattern& pattern, std::vector<Contribution>& result) {
  for_pairs(rows, [&](int row, const SignedEntry& e, const SignedEntry& f) {
    const int source = first + signed_product(lowered, row, e, f);
    result.push_back({pattern.index({e.column, f.column}), source});
  });
}

}  // namespace

HalfPattern tangent_pattern(const Model& model) {
  std::vector<int> number(model.variables());
  std::iota(number.begin(), number.end(), 0);
  const Coordinates coordinates(model, number);
  const LoweredConstraints lowered(model, coordinates);
  std::vector<Position> positions;
  const auto push = [&](int, const SignedEntry& e, const SignedEntry& f) {
    positions.push_back({e.column, f.column});
  };
  for (const MassEntry& e : model.mass()) positions.push_back({e.row, e.col});
  for_pairs(lowered.entries(), push);
  for_pairs(LoweredForces(model, coordinates).gradients(), push);
  for_linear_pairs(lowered.linear, [&](int i, int j, double) { positions.push_back({i, j}); });
  return HalfPattern(Half::lower, model.variables(), positions);
}

std::vector<double> mass_values(const Model& model, const HalfPattern& pattern,
                                const std::vector<int>& number) {
  std::vector<double> values(pattern.nonzeros());
  for (const MassEntry& e : model.mass()) {
    values[pattern.index({number[e.row], number[e.col]})] = e.value;
  }
  return values;
}

void add_linear_products(const LinearBlock& linear, const HalfPattern& pattern, double factor,
                         std::vector<double>& values) {
  for_linear_pairs(linear, [&](int i, int j, double product) {
    values[pattern.index({i, j})] += factor * product;
  });
}

void add_row_contributions(const SignedRows& rows, int values, std::vector<Contribution>& result) {
  for (int row = 0; row < rows.rows(); ++row) {
    for (const SignedEntry& e : rows[row]) {
      result.push_back({e.column, e.value + (e.negative ? values : 0)});
    }
  }
}

std::vector<Contribution> row_contributions(const LoweredConstraints& lowered) {
  std::vector<Contribution> result;
  add_row_contributions(lowered.entries(), lowered.values(), result);
  int source = 2 * lowered.values();
  for (int column : lowered.linear.column) result.push_back({column, source++});
  return result;
}

std::vector<Contribution> tangent_contributions(const LoweredConstraints& lowered,
                                                const HalfPattern& pattern) {
  std::vector<Contribution> result;
  add_products(lowered, lowered.entries(), 0, pattern, result);
  return result;
}

std::vector<Contribution> tangent_contributions(const LoweredConstraints& lowered,
                                                const LoweredForces& forces,
                                                const HalfPattern& pattern) {
  std::vector<Contribution> result = tangent_contributions(lowered, pattern);
  add_products(forces, forces.gradients(), 2 * lowered.products(), pattern, result);
  return result;
}

}  // namespace mbs::csc_cholmod
