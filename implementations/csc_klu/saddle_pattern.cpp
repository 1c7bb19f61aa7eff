// The pattern of the saddle-point matrix and where its values are, found once.
#include "saddle_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elimination_order.hpp"

namespace mbs::csc_klu {
namespace {

/// Calls visit(multiplier, coordinate, coefficient) for every term of a linear constraint.
template <int dim, class Visit>
void visit_linear(const JacobianPattern<dim>& jacobian, int n, Visit visit) {
  int multiplier = n + jacobian.quadratics(), k = 0;
  for (const auto& linear : jacobian.linears) {
    for (; k < linear.terms_end; ++k) {
      visit(multiplier, jacobian.linear_terms[k].coordinate, jacobian.linear_terms[k].coefficient);
    }
    ++multiplier;
  }
}

/// Calls visit(multiplier, coordinate) with the first coordinate of every Jacobian block.
template <int dim, class Visit>
void visit_blocks(const JacobianPattern<dim>& jacobian, int n, Visit visit) {
  for (int p = 0; p < jacobian.points(); ++p) {
    for (int block = jacobian.block_begin[p]; block < jacobian.block_begin[p + 1]; ++block) {
      visit(n + jacobian.block_row[block], dim * p);
    }
  }
}

/// By row, what it owns. A linear constraint is a substitution for the coordinate with the largest
/// coefficient of those that no other linear one has, unless that is far below the row's largest.
/// Another constraint owns a point that no other has, which the constraint's other points lean on
/// then, unless it is far heavier than they are.
template <int dim>
std::vector<Owned> owned_coordinates(const Model& model, const JacobianPattern<dim>& jacobian) {
  constexpr double kFarBelow = 1e-3;
  const int n = model.variables();
  const std::size_t rows = jacobian.model_row.size();
  std::vector<int> rows_with(n, 0);
  std::vector<Owned> owned(rows);
  std::vector<double> enough(rows, 0.0);
  visit_linear(jacobian, n, [&](int multiplier, int coordinate, double coefficient) {
    ++rows_with[coordinate];
    double& least = enough[multiplier - n];
    least = std::max(least, kFarBelow * std::abs(coefficient));
  });
  visit_linear(jacobian, n, [&](int multiplier, int coordinate, double coefficient) {
    const int row = multiplier - n;
    if (rows_with[coordinate] > 1 || std::abs(coefficient) <= enough[row]) return;
    enough[row] = std::abs(coefficient);
    owned[row] = {coordinate, 1};
  });
  std::vector<double> mass(n, 0.0), lightest(rows, HUGE_VAL);  // of the points of a row
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == entry.col) mass[entry.row] = entry.value;
  }
  visit_blocks(jacobian, n, [&](int multiplier, int coordinate) {
    lightest[multiplier - n] = std::min(lightest[multiplier - n], mass[coordinate]);
  });
  visit_blocks(jacobian, n, [&](int multiplier, int coordinate) {
    const int* block = &jacobian.block_begin[coordinate / dim];
    const int* linear = &rows_with[coordinate];
    const bool alone = block[1] - block[0] == 1 && std::count(linear, linear + dim, 0) == dim;
    if (alone && kFarBelow * mass[coordinate] <= lightest[multiplier - n]) {
      owned[multiplier - n] = {coordinate, dim};
    }
  });
  return owned;
}

template <int dim>
Pattern saddle_pattern(const Model& model, const JacobianPattern<dim>& jacobian,
                       const std::vector<ElementBlock>& elements,
                       const std::vector<HessianEntry>& hessians) {
  const int n = model.variables(), size = n + model.constraints();
  std::vector<Pattern::Position> positions = mass_positions(model);
  for (const ElementBlock& block : elements) {
    for (int col = dim * block.q; col < dim * block.q + dim; ++col) {
      for (int k = 0; k < dim; ++k) positions.push_back({dim * block.p + k, col});
    }
  }
  for (const HessianEntry& entry : hessians) positions.push_back({entry.row, entry.col});
  const auto add_both = [&](int multiplier, int coordinate) {
    positions.push_back({multiplier, coordinate});
    positions.push_back({coordinate, multiplier});
  };
  visit_blocks(jacobian, n, [&](int multiplier, int coordinate) {
    for (int k = 0; k < dim; ++k) add_both(multiplier, coordinate + k);
  });
  visit_linear(jacobian, n,
               [&](int multiplier, int coordinate, double) { add_both(multiplier, coordinate); });
  for (int i = n; i < size; ++i) positions.push_back({i, i});
  return Pattern(size, std::move(positions));
}

}  // namespace

template <int dim>
SaddlePattern<dim>::SaddlePattern(const Model& model, const JacobianPattern<dim>& jacobian,
                                  const std::vector<ElementBlock>& elements,
                                  const std::vector<HessianEntry>& hessians, Order elimination)
    : pattern(saddle_pattern(model, jacobian, elements, hessians)),
      order(saddle_order(pattern, model.variables(), owned_coordinates(model, jacobian),
                         elimination)),
      shares(elements, pattern, [](int, int) { return false; }) {
  const int n = model.variables();
  visit_blocks(jacobian, n, [&](int multiplier, int coordinate) {
    Block block{multiplier - n, pattern.offset(coordinate, multiplier), {}};
    for (int k = 0; k < dim; ++k) block.below[k] = pattern.offset(multiplier, coordinate + k);
    blocks.push_back(block);
  });
  visit_linear(jacobian, n, [&](int multiplier, int coordinate, double coefficient) {
    constants.push_back({multiplier - n, pattern.offset(coordinate, multiplier),
                         pattern.offset(multiplier, coordinate), coefficient});
  });
  for (int i = n; i < pattern.columns(); ++i) diagonal.push_back(pattern.offset(i, i));
}

template struct SaddlePattern<2>;
template struct SaddlePattern<3>;

}  // namespace mbs::csc_klu
