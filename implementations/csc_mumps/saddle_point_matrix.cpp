// Blocks of the saddle-point matrix, their values, and the order of its variables.
#include "saddle_point_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace mbs::csc_mumps {

namespace {

constexpr double kFarBelow = 1e-3;

/// The coordinates of a point that no row but this one has, of `rows` of Phi_q up to the linear
/// ones. It must not be far heavier than the row's other points, which lean on it.
void own_points(const Model& model, const std::vector<std::vector<RowEntry>>& rows,
                std::vector<std::vector<int>>& owned) {
  std::vector<int> rows_with(model.variables(), 0);
  for (const auto& row : rows) {
    for (const RowEntry& entry : row) ++rows_with[entry.column];
  }
  std::vector<double> mass(model.variables(), 0.0);
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == entry.col) mass[entry.row] = entry.value;
  }
  std::vector<int> point_of(model.variables());  // by coordinate: its point's first
  for (const Point& point : model.points()) {
    if (point.is_fixed()) continue;
    std::fill_n(point_of.begin() + point.offset, model.dimension(), point.offset);
  }
  for (std::size_t k = 0; k < rows.size() - model.linear_constraints().size(); ++k) {
    double lightest = HUGE_VAL;
    for (const RowEntry& entry : rows[k]) lightest = std::min(lightest, mass[entry.column]);
    for (const RowEntry& entry : rows[k]) {
      const auto first = rows_with.begin() + point_of[entry.column];
      const bool is_alone = std::count(first, first + model.dimension(), 1) == model.dimension();
      if (!is_alone || kFarBelow * mass[entry.column] > lightest) continue;
      owned[k].resize(model.dimension());
      std::iota(owned[k].begin(), owned[k].end(), point_of[entry.column]);
    }
  }
}

/// By row: the coordinates that it owns. Of a linear row it is the one with the largest coefficient
/// of those that no other linear row has, unless that is far below the row's largest.
std::vector<std::vector<int>> owned_coordinates(const Model& model,
                                                const std::vector<std::vector<RowEntry>>& rows) {
  const auto linears = model.linear_constraints();
  std::vector<std::vector<int>> owned(rows.size());
  own_points(model, rows, owned);
  std::vector<int> rows_with(model.variables(), 0);
  for (const LinearConstraint& linear : linears) {
    for (const LinearConstraint::Term& term : linear.terms) ++rows_with[term.coordinate];
  }
  for (std::size_t k = 0; k < linears.size(); ++k) {
    const auto size = [](const LinearConstraint::Term& term) { return std::abs(term.coefficient); };
    const auto& terms = linears[k].terms;
    double most =
        terms.empty() ? 0.0 : kFarBelow * size(*std::ranges::max_element(terms, {}, size));
    for (const LinearConstraint::Term& term : terms) {
      if (rows_with[term.coordinate] > 1 || size(term) <= most) continue;
      most = size(term);
      owned[owned.size() - linears.size() + k] = {term.coordinate};
    }
  }
  return owned;
}

}  // namespace

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

std::vector<int> SaddlePointMatrix::elimination_order(const Model& model, Tuning tuning) const {
  const auto rows = rows_of(assembly_.jacobian_pattern(), constraints_);
  const auto owned = owned_coordinates(model, rows);
  Triplets graph{variables_, {}, {}};
  graph.add(inertia_pattern_);
  for (const auto& row : rows) {
    for (std::size_t i = 1; i < row.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) graph.add(row[i].column, row[j].column);
    }
  }
  // Of a coordinate its position, of a multiplier that of its last coordinate, or 0; of one that
  // owns some that of the last of these. Whoever has one of them waits for the owner's others too.
  std::vector<int> rank = MultifrontalSolver::positions(std::move(graph), tuning), last_of;
  for (const auto& row : rows) {
    int last = 0;
    for (const RowEntry& entry : row) last = std::max(last, rank[entry.column]);
    last_of.push_back(last);
  }
  std::vector<int> owner(variables_, -1);
  for (int k = 0; k < constraints_; ++k) {
    for (const int coordinate : owned[k]) owner[coordinate] = k;
  }
  for (int k = 0; k < constraints_; ++k) {
    int last = owned[k].empty() ? last_of[k] : 0;
    for (const int coordinate : owned[k]) last = std::max(last, rank[coordinate]);
    for (const RowEntry& entry : rows[k]) {
      const int other = owner[entry.column];
      if (other >= 0 && owned[k].empty()) last = std::max(last, last_of[other]);
    }
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
