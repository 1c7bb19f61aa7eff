// Patterns, schedules and the numeric assembly of the tangent.
#include "assembly.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mbs::csc_ldl {

namespace {

constexpr double kFarBelow = 1e-3;

/// Of each row that is not linear, the variables of a point that no other row has. But the other
/// points lean on it, so it is not far heavier than they are.
std::vector<std::vector<int>> owned_points(const Model& model, const Constraints& constraints) {
  std::vector<double> mass(model.variables()), lightest(constraints.count(), HUGE_VAL);
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == entry.col) mass[entry.row] = entry.value;
  }
  std::vector<int> row_with(model.variables(), -1);  // or many
  const int many = constraints.count();
  constraints.visit_forces([&](int row, int i, int) {
    row_with[i] = row_with[i] < 0 || row_with[i] == row ? row : many;
    lightest[row] = std::min(lightest[row], mass[i]);
  });
  std::vector<std::vector<int>> owned(many - model.linear_constraints().size());
  for (const Point& point : model.points()) {
    if (point.is_fixed()) continue;
    std::vector<int> variables(model.dimension());
    std::iota(variables.begin(), variables.end(), point.offset);
    const int row = row_with[point.offset];
    const auto is_alone = [&](int i) { return row_with[i] == row; };
    if (row >= 0 && row < static_cast<int>(owned.size()) &&
        std::ranges::all_of(variables, is_alone) &&
        kFarBelow * mass[point.offset] <= lightest[row]) {
      owned[row] = variables;
    }
  }
  return owned;
}

/// Of each row, the variables that it comes right after, or none. Of a linear row it is the one
/// with the largest coefficient of those that no other linear row has, unless that is far below the
/// row's largest, as it is divided by: the row is a substitution for it.
std::vector<std::vector<int>> owned_variables(const Model& model, const Constraints& constraints) {
  std::vector<int> rows_with(model.variables(), 0);
  for (const LinearConstraint& linear : model.linear_constraints()) {
    for (const LinearConstraint::Term& term : linear.terms) ++rows_with[term.coordinate];
  }
  std::vector<std::vector<int>> owned = owned_points(model, constraints);
  for (const LinearConstraint& linear : model.linear_constraints()) {
    double largest = 0.0;
    for (const auto& term : linear.terms) largest = std::max(largest, std::abs(term.coefficient));
    double most = kFarBelow * largest;
    owned.emplace_back();
    for (const auto& [variable, coefficient] : linear.terms) {
      if (rows_with[variable] > 1 || std::abs(coefficient) <= most) continue;
      most = std::abs(coefficient);
      owned.back() = {variable};
    }
  }
  return owned;
}

}  // namespace

Numbering number_unknowns(const Model& model, bool saddle_point, Order kind) {
  const int n = model.variables();
  Numbering numbering;
  numbering.state.resize(n);
  std::iota(numbering.state.begin(), numbering.state.end(), 0);
  const Coordinates at(model, numbering.state);
  const Constraints constraints(model, at);
  const Elements elements(model, at, 1.0);

  EliminationProblem problem;
  problem.variables = n;
  if (saddle_point) {
    problem.rows = constraints.count();
    problem.owned = owned_variables(model, constraints);
  }
  const auto couple = [&](int i, int j) {
    if (i < j) problem.entries.emplace_back(i, j);
  };
  for (const MassEntry& entry : model.mass()) couple(entry.col, entry.row);
  elements.visit_products([&](int i, int j, int) { couple(i, j); });
  if (saddle_point) {
    constraints.visit_forces([&](int row, int i, int) { couple(i, n + row); });
  } else {
    constraints.visit_products([&](int i, int j, int) { couple(i, j); });
    constraints.visit_linear([&](int i, int j, double) { couple(i, j); });
  }

  const std::vector<int> order = elimination_order(problem, kind);
  numbering.row.resize(problem.rows);
  for (int place = 0; place < n + problem.rows; ++place) {
    if (order[place] < n) {
      numbering.state[order[place]] = static_cast<int>(numbering.variable.size());
      numbering.variable.push_back(place);
    } else {
      numbering.row[order[place] - n] = place;
    }
  }
  return numbering;
}

Assembly::Assembly(const Model& model, const StepSettings& settings, const Numbering& numbering,
                   const Constraints& constraints, const Elements& elements)
    : saddle_point_(settings.scheme == Scheme::saddle_point),
      factor_(settings.step * settings.step / 4 * settings.penalty),
      numbering_(numbering),
      row_parts_(saddle_point_ ? constraints.force_parts() : constraints.matrix_parts()),
      parts_(row_parts_ + elements.matrix_parts()),
      ones_(saddle_point_ ? constraints.count() : 0, 1.0) {
  const std::vector<int>&state = numbering_.state, &variable = numbering_.variable,
        &row = numbering_.row;
  // Places of all entries in the upper triangle, then what they are the sum of.
  struct Contribution {
    int col, row, part;  // part -1: a constant
    double constant;
  };
  std::vector<Contribution> all;
  const auto add = [&](int i, int j, int part, double constant) {
    if (i <= j) all.push_back({j, i, part, constant});  // (i, j) and (j, i) both come
  };
  for (const MassEntry& entry : model.mass()) {
    const int i = variable[state[entry.row]], j = variable[state[entry.col]];
    add(std::min(i, j), std::max(i, j), -1, entry.value);
  }
  elements.visit_products(
      [&](int i, int j, int part) { add(variable[i], variable[j], row_parts_ + part, 0.0); });
  if (saddle_point_) {
    constraints.visit_forces([&](int k, int i, int part) {
      add(std::min(row[k], variable[i]), std::max(row[k], variable[i]), part, 0.0);
    });
    for (const int place : row) add(place, place, -1, -1 / factor_);  // -epsilon
  } else {
    constraints.visit_products(
        [&](int i, int j, int part) { add(variable[i], variable[j], part, 0.0); });
    constraints.visit_linear([&](int i, int j, double product) {
      add(variable[i], variable[j], -1, factor_ * product);
    });
  }

  std::ranges::stable_sort(all, {},
                           [](const Contribution& one) { return std::pair(one.col, one.row); });
  pattern_.size = static_cast<int>(variable.size() + row.size());
  pattern_.begin.resize(pattern_.size + 1);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k == 0 || all[k].col != all[k - 1].col || all[k].row != all[k - 1].row) {
      pattern_.row.push_back(all[k].row);
      constant_.push_back(0.0);
      ++pattern_.begin[all[k].col + 1];
    }
    const int position = static_cast<int>(constant_.size()) - 1;
    constant_[position] += all[k].constant;
    if (all[k].part >= 0) sums_.add(position, all[k].part);
  }
  std::partial_sum(pattern_.begin.begin(), pattern_.begin.end(), pattern_.begin.begin());
  sums_.finish();

  std::vector<double> sign(pattern_.size, 1.0);
  for (const int place : row) sign[place] = -1.0;
  solver_ = LdlSolver(pattern_, std::move(sign));
  solver_.values() = constant_;
  if (saddle_point_) system_.resize(pattern_.size);
}

void Assembly::assemble(const Constraints& constraints) {
  if (saddle_point_) {
    constraints.write_forces(ones_.data(), parts_.data());
  } else {
    constraints.write_products(factor_, parts_.data());
  }
  sums_.apply(constant_.data(), parts_.data(), solver_.values().data());
}

void Assembly::solve(std::vector<double>& top, std::vector<double>& bottom) {
  if (!saddle_point_) return solver_.solve(top.data());
  const std::vector<int>&variable = numbering_.variable, &row = numbering_.row;
  for (std::size_t i = 0; i < variable.size(); ++i) system_[variable[i]] = top[i];
  for (std::size_t k = 0; k < row.size(); ++k) system_[row[k]] = bottom[k];
  solver_.solve(system_.data());
  for (std::size_t i = 0; i < variable.size(); ++i) top[i] = system_[variable[i]];
  for (std::size_t k = 0; k < row.size(); ++k) bottom[k] = system_[row[k]];
}

std::vector<double> Assembly::dense() const {
  const std::size_t n = numbering_.variable.size();
  std::vector<int> coordinate(pattern_.size, -1);  // of the model, by place in the system
  for (std::size_t i = 0; i < n; ++i) {
    coordinate[numbering_.variable[numbering_.state[i]]] = static_cast<int>(i);
  }
  std::vector<double> matrix(n * n);
  for (int col = 0; col < pattern_.size; ++col) {
    for (int k = pattern_.begin[col]; k < pattern_.begin[col + 1]; ++k) {
      const int i = coordinate[pattern_.row[k]], j = coordinate[col];
      if (i < 0 || j < 0) continue;
      matrix[i * n + j] = matrix[j * n + i] = solver_.values()[k];
    }
  }
  return matrix;
}

}  // namespace mbs::csc_ldl
