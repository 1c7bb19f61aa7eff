// Blocks of the saddle-point matrix, their values, and the order of its variables.
#include "saddle_point_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "solver.hpp"

namespace mbs::csc_mumps {

SaddlePointMatrix::SaddlePointMatrix(const Model& model, const Assembly& assembly,
                                     const StepSettings& settings)
    : assembly_(assembly), variables_(model.variables()), constraints_(model.constraints()) {
  std::vector<std::pair<int, int>> entries;
  for (const MassEntry& mass : model.mass()) entries.emplace_back(mass.col, mass.row);
  assembly.forces().visit_couplings(
      [&](int row, int column) { entries.emplace_back(column, row); });
  inertia_pattern_ = pattern_of(variables_, std::move(entries));
  mass_.assign(inertia_pattern_.row.size(), 0.0);
  for (const MassEntry& mass : model.mass()) {
    mass_[inertia_pattern_.entry(mass.row, mass.col)] = mass.value;
  }
  assembly.forces().visit_couplings(
      [&](int row, int column) { force_places_.push_back(inertia_pattern_.entry(row, column)); });
  values_ = mass_;
  values_.insert(values_.end(), assembly.jacobian().begin(), assembly.jacobian().end());
  const double epsilon = 4.0 / (settings.penalty * settings.step * settings.step);
  values_.insert(values_.end(), constraints_, -epsilon);  // Eq. (12)
}

Triplets SaddlePointMatrix::pattern() const {
  Triplets result{variables_ + constraints_, {}, {}};
  result.add(inertia_pattern_);
  result.add(assembly_.jacobian_pattern(), variables_);
  for (int i = variables_; i < result.order; ++i) result.add(i, i);
  return result;
}

std::vector<int> SaddlePointMatrix::elimination_order() const {
  const auto rows = rows_of(assembly_.jacobian_pattern(), constraints_);
  Triplets graph{variables_, {}, {}};
  graph.add(inertia_pattern_);
  for (const auto& row : rows) {
    for (std::size_t i = 1; i < row.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) graph.add(row[i].column, row[j].column);
    }
  }
  // Of a coordinate its position, of a multiplier that of its last coordinate, or 0.
  std::vector<int> rank = MultifrontalSolver::minimum_degree(std::move(graph));
  for (const auto& row : rows) {
    int last = 0;
    for (const RowEntry& entry : row) last = std::max(last, rank[entry.column]);
    rank.push_back(last);
  }
  std::vector<int> order(rank.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return rank[i] < rank[j]; });
  std::vector<int> position(rank.size());
  for (std::size_t k = 0; k < order.size(); ++k) position[order[k]] = static_cast<int>(k) + 1;
  return position;
}

bool SaddlePointMatrix::evaluate() {
  const Forces& forces = assembly_.forces();
  if (!forces.empty()) {
    std::copy(mass_.begin(), mass_.end(), values_.begin());
    forces.add_to_tangent(force_places_.data(), values_.data());
  }
  double sum = 0.0;  // squares of the forces' gradients are on the diagonal of T0
  for (int j = 0; j < variables_; ++j) sum += values_[inertia_pattern_.start[j]];
  double* target = values_.data() + mass_.size();
  for (const double value : assembly_.jacobian()) {
    *target++ = value;
    sum += value;
  }
  return std::isfinite(sum);
}

}  // namespace mbs::csc_mumps
