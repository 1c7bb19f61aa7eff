// Set-up and refresh of the matrix of Eq. (12).
#include "saddle_point_matrix.hpp"

#include <algorithm>
#include <cmath>

#include "elimination_order.hpp"

namespace mbs::csc_umfpack {
namespace {

Lists element_coordinates(const ForceLayout& forces, int dimension) {
  Lists sets;
  add_element_coordinates(forces, dimension, sets);
  return sets;
}

/// By row: the coordinate that it is a substitution for, or -1. Of a linear row it is the one with
/// the largest coefficient of those that no other linear row has, unless that is far below the
/// row's largest.
std::vector<int> owned_coordinates(const JacobianLayout& layout, int variables) {
  constexpr double kFarBelow = 1e-3;
  std::vector<int> rows_with(variables, 0);
  for (const LinearConstraint::Term& term : layout.terms) ++rows_with[term.coordinate];
  std::vector<int> owned(layout.rows() - layout.linears.size(), -1);
  for (const JacobianLayout::Linear& linear : layout.linears) {
    double largest = 0.0, most = 0.0;
    int found = -1;
    for (int k = linear.first; k < linear.last; ++k) {
      const auto& [coordinate, coefficient] = layout.terms[k];
      largest = std::max(largest, std::abs(coefficient));
      if (rows_with[coordinate] > 1 || std::abs(coefficient) <= most) continue;
      most = std::abs(coefficient);
      found = coordinate;
    }
    owned.push_back(most > kFarBelow * largest ? found : -1);
  }
  return owned;
}

}  // namespace

template <int D>
SaddlePointSchedule<D>::SaddlePointSchedule(const SparsityPattern& mass,
                                            const JacobianLayout& layout, const ForceLayout& forces)
    : SaddlePointSchedule(mass, layout, forces, row_coordinates(layout, D)) {}

template <int D>
SaddlePointSchedule<D>::SaddlePointSchedule(const SparsityPattern& mass,
                                            const JacobianLayout& layout, const ForceLayout& forces,
                                            const Lists& rows)
    : pattern(bordered_pattern(union_pattern(mass, element_coordinates(forces, D)), rows)),
      places(element_places<D>(pattern, forces)) {
  Lists coupled = rows;
  add_element_coordinates(forces, D, coupled);
  order = elimination_order(union_pattern(mass, coupled), rows,
                            owned_coordinates(layout, mass.variables()));
  const int n = mass.variables();
  for (const auto& block : layout.blocks) {
    Block at{pattern.position(block.offset, n + block.row)};
    for (int k = 0; k < D; ++k) at.row[k] = pattern.position(n + block.row, block.offset + k);
    blocks.push_back(at);
  }
  for (const Place<D>& place : places) {
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) {
        with_elements.push_back(place.position[j] + i);
        with_elements.push_back(place.mirrored[i] + j);
      }
    }
  }
  std::sort(with_elements.begin(), with_elements.end());
  with_elements.erase(std::unique(with_elements.begin(), with_elements.end()), with_elements.end());
}

template <int D>
SaddlePointMatrix<D>::SaddlePointMatrix(const MassMatrix& mass, const JacobianLayout& layout,
                                        const ForceLayout& forces, double epsilon)
    : schedule_(mass.pattern(), layout, forces), values_(schedule_.pattern.rows.size(), 0.0) {
  const SparsityPattern &M = mass.pattern(), &K = schedule_.pattern;
  const int n = M.variables();
  for (int col = 0; col < n; ++col) {
    int position = K.starts[col];
    for (int k = M.starts[col]; k < M.starts[col + 1]; ++k) {
      while (K.rows[position] != M.rows[k]) ++position;
      values_[position] = mass.values()[k];
    }
  }
  for (const int position : schedule_.with_elements) constant_.push_back(values_[position]);
  int row = K.variables() - static_cast<int>(layout.linears.size());
  for (const auto& linear : layout.linears) {
    for (int t = linear.first; t < linear.last; ++t) {
      const auto& [coordinate, coefficient] = layout.terms[t];
      values_[K.position(coordinate, row)] = coefficient;
      values_[K.position(row, coordinate)] = coefficient;
    }
    ++row;
  }
  for (int i = n; i < K.variables(); ++i) values_[K.position(i, i)] = -epsilon;
}

template <int D>
void SaddlePointMatrix<D>::update(const Jacobian<D>& jacobian, const Forces<D>& forces) {
  double* K = values_.data();
  const double* constant = constant_.data();
  for (const int position : schedule_.with_elements) K[position] = *constant++;
  forces.add_tangent(schedule_.places, K);
  const double* J = jacobian.values();
  for (const auto& block : schedule_.blocks) {
    std::copy_n(J, D, K + block.column);  // Eq. (12)
    for (int k = 0; k < D; ++k) K[block.row[k]] = J[k];
    J += D;
  }
}

template struct SaddlePointSchedule<2>;
template struct SaddlePointSchedule<3>;
template class SaddlePointMatrix<2>;
template class SaddlePointMatrix<3>;

}  // namespace mbs::csc_umfpack
