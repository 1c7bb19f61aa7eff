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

/// By row: the coordinates that it owns. Of a linear row it is the one with the largest coefficient
/// of those that no other linear row has, unless that is far below the row's largest: the row is a
/// substitution for it. Of another row it is a point that no other row has, unless that is far
/// heavier than the row's others, which lean on it.
Lists owned_coordinates(const JacobianLayout& layout, const Lists& rows, const MassMatrix& mass,
                        int dimension) {
  constexpr double kFarBelow = 1e-3;
  const Lists rows_of = transpose(rows, mass.pattern().variables());  // linear rows are the last
  const auto mass_of = [&mass](int i) { return mass.values()[mass.pattern().position(i, i)]; };
  Lists owned;
  auto block = layout.blocks.begin();
  const int block_rows = layout.rows() - static_cast<int>(layout.linears.size());
  for (int row = 0; row < block_rows; ++row, owned.end_list()) {
    double lightest = HUGE_VAL;
    for (const int i : rows[row]) lightest = std::min(lightest, mass_of(i));
    int found = -1;
    for (; block != layout.blocks.end() && block->row == row; ++block) {
      bool is_alone = kFarBelow * mass_of(block->offset) <= lightest;
      for (int k = 0; k < dimension; ++k) is_alone &= rows_of[block->offset + k].size() == 1;
      if (is_alone) found = block->offset;
    }
    for (int k = 0; found >= 0 && k < dimension; ++k) owned.items.push_back(found + k);
  }
  for (const JacobianLayout::Linear& linear : layout.linears) {
    double largest = 0.0, most = 0.0;
    int found = -1;
    for (int k = linear.first; k < linear.last; ++k) {
      const auto& [coordinate, coefficient] = layout.terms[k];
      largest = std::max(largest, std::abs(coefficient));
      const auto with = rows_of[coordinate];
      const bool is_shared = with.size() > 1 && with[with.size() - 2] >= block_rows;
      if (is_shared || std::abs(coefficient) <= most) continue;
      most = std::abs(coefficient);
      found = coordinate;
    }
    if (most > kFarBelow * largest) owned.items.push_back(found);
    owned.end_list();
  }
  return owned;
}

}  // namespace

template <int D>
SaddlePointSchedule<D>::SaddlePointSchedule(const MassMatrix& mass, const JacobianLayout& layout,
                                            const ForceLayout& forces, Tuning tuning)
    : SaddlePointSchedule(mass, layout, forces, tuning, row_coordinates(layout, D)) {}

template <int D>
SaddlePointSchedule<D>::SaddlePointSchedule(const MassMatrix& mass, const JacobianLayout& layout,
                                            const ForceLayout& forces, Tuning tuning,
                                            const Lists& rows)
    : pattern(
          bordered_pattern(union_pattern(mass.pattern(), element_coordinates(forces, D)), rows)),
      places(element_places<D>(pattern, forces)) {
  Lists coupled = rows;
  add_element_coordinates(forces, D, coupled);
  const Lists owned = owned_coordinates(layout, rows, mass, D);
  for (const auto& order : orders_of(union_pattern(mass.pattern(), coupled), tuning)) {
    orders.push_back(elimination_order(order, rows, owned));
  }
  const int n = mass.pattern().variables();
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
                                        const ForceLayout& forces, double epsilon, Tuning tuning)
    : schedule_(mass, layout, forces, tuning), values_(schedule_.pattern.rows.size(), 0.0) {
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
