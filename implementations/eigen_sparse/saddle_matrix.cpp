// Set-up and refresh of the saddle-point matrix.
#include "saddle_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mbs::eigen_sparse {
namespace {

constexpr double kFarBelow = 1e-3;

/// The unknowns that each row owns.
using Owned = std::vector<std::vector<int>>;

/// Lets each row in front of `first` own a point that no other row has (`rows_with`: by unknown,
/// how many have it). The row's other points lean on it then, so that it must not be far heavier
/// than they are.
void own_points(const Model& model, const Coordinates& coordinates, const RowSparseMatrix& jacobian,
                int first, const std::vector<int>& rows_with, Owned& owned) {
  Vector mass = Vector::Zero(jacobian.cols());
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == entry.col) mass[coordinates.of_unknown(entry.row)] = entry.value;
  }
  std::vector<int> row_of(jacobian.cols());
  std::vector<double> lightest(jacobian.rows(), HUGE_VAL);
  for (int row = 0; row < jacobian.rows(); ++row) {
    for (RowSparseMatrix::InnerIterator it(jacobian, row); it; ++it) {
      row_of[it.col()] = row;
      lightest[row] = std::min(lightest[row], mass[it.col()]);
    }
  }
  for (int point = 0; point < static_cast<int>(model.points().size()); ++point) {
    if (!coordinates.is_free(point)) continue;
    std::vector<int> unknowns;
    for (int axis = 0; axis < coordinates.dimension(); ++axis) {
      unknowns.push_back(coordinates.of_point(point, axis));
    }
    const int row = row_of[unknowns[0]];
    const auto is_alone = [&](int unknown) { return rows_with[unknown] == 1; };
    if (row < first && std::ranges::all_of(unknowns, is_alone) &&
        kFarBelow * mass[unknowns[0]] <= lightest[row]) {
      owned[row] = unknowns;
    }
  }
}

/// A linear row (from `first` on) owns the unknown with its largest coefficient of those that no
/// other linear row has, unless that is far below the row's largest: the row is a substitution for
/// it.
Owned owned_unknowns(const Model& model, const Coordinates& coordinates,
                     const RowSparseMatrix& jacobian, int first) {
  std::vector<int> rows_with(jacobian.cols());
  Owned owned(jacobian.rows());
  const int* const begin = jacobian.innerIndexPtr();
  const int* const linear = begin + jacobian.outerIndexPtr()[first];
  const auto count = [&rows_with](int unknown) { ++rows_with[unknown]; };
  std::for_each(linear, begin + jacobian.nonZeros(), count);
  for (int row = first; row < jacobian.rows(); ++row) {
    double largest = 0.0;
    for (RowSparseMatrix::InnerIterator it(jacobian, row); it; ++it) {
      largest = std::max(largest, std::abs(it.value()));
    }
    double most = kFarBelow * largest;
    for (RowSparseMatrix::InnerIterator it(jacobian, row); it; ++it) {
      if (rows_with[it.col()] > 1 || std::abs(it.value()) <= most) continue;
      most = std::abs(it.value());
      owned[row] = {static_cast<int>(it.col())};
    }
  }
  std::for_each(begin, linear, count);
  own_points(model, coordinates, jacobian, first, rows_with, owned);
  return owned;
}

/// A multiplier follows the unknowns that its row of Phi_q has. But a row that owns unknowns
/// follows these, and rows that have one of them wait for the unknowns of its owner too.
Followers followers_of(const RowSparseMatrix& jacobian, const Owned& owned) {
  const auto unknowns = static_cast<int>(jacobian.cols());
  Followers followers(unknowns + jacobian.rows());
  std::vector<int> owner(unknowns, -1);
  for (int row = 0; row < jacobian.rows(); ++row) {
    for (const int unknown : owned[row]) {
      owner[unknown] = row;
      followers[unknown].push_back(unknowns + row);
    }
  }
  for (int row = 0; row < jacobian.rows(); ++row) {
    if (!owned[row].empty()) continue;
    for (RowSparseMatrix::InnerIterator it(jacobian, row); it; ++it) {
      followers[it.col()].push_back(unknowns + row);
      if (owner[it.col()] < 0) continue;
      for (RowSparseMatrix::InnerIterator of(jacobian, owner[it.col()]); of; ++of) {
        followers[of.col()].push_back(unknowns + row);
      }
    }
  }
  return followers;
}

/// Eqs. (12), (14) with `upper_left` (n x n, both triangles) and Phi_q as it is; both triangles.
SparseMatrix assembled(const SparseMatrix& upper_left, const RowSparseMatrix& jacobian,
                       double epsilon, std::span<const int> place) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int col = 0; col < upper_left.cols(); ++col) {
    for (SparseMatrix::InnerIterator it(upper_left, col); it; ++it) {
      entries.emplace_back(place[it.row()], place[col], it.value());
    }
  }
  for (int row = 0; row < jacobian.rows(); ++row) {
    const int at = place[jacobian.cols() + row];
    entries.emplace_back(at, at, -epsilon);
    for (int k = jacobian.outerIndexPtr()[row]; k < jacobian.outerIndexPtr()[row + 1]; ++k) {
      const int col = place[jacobian.innerIndexPtr()[k]];
      entries.emplace_back(at, col, jacobian.valuePtr()[k]);
      entries.emplace_back(col, at, jacobian.valuePtr()[k]);
    }
  }
  const auto size = static_cast<int>(place.size());
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

SaddleMatrix::SaddleMatrix(const Model& model, const Coordinates& coordinates,
                           const Constraints& constraints, Triangle triangle, double epsilon,
                           Stiffness stiffness, SaddleOrder order, Tuning tuning)
    : triangle_(triangle),
      variables_(model.variables()),
      place_(model.variables() + model.constraints()) {
  const RowSparseMatrix& jacobian = constraints.jacobian();
  const SparseMatrix upper_left = stiffness == Stiffness::added
                                      ? stiffness_pattern(model, coordinates)
                                      : SparseMatrix(mass_matrix(model, coordinates));
  const Followers followers =
      followers_of(jacobian, owned_unknowns(model, coordinates, jacobian, constraints.quadratic()));
  std::iota(place_.begin(), place_.end(), 0);
  place_ = order(assembled(upper_left, jacobian, epsilon, place_), followers, model, coordinates,
                 tuning);
  matrix_ = assembled(upper_left, jacobian, epsilon, place_);
  if (triangle == Triangle::upper) matrix_ = SparseMatrix(matrix_.triangularView<Eigen::Upper>());
  if (stiffness == Stiffness::added) {
    base_ = Eigen::Map<const Vector>(matrix_.valuePtr(), matrix_.nonZeros());
  }
  for (int row = 0; row < constraints.quadratic(); ++row) {
    for (int k = jacobian.outerIndexPtr()[row]; k < jacobian.outerIndexPtr()[row + 1]; ++k) {
      const auto [low, high] =
          std::minmax({place_[jacobian.innerIndexPtr()[k]], multipliers()[row]});
      slots_.push_back(slot_of(matrix_, low, high));
      if (triangle == Triangle::full) mirrored_.push_back(slot_of(matrix_, high, low));
    }
  }
}

void SaddleMatrix::refresh(const RowSparseMatrix& jacobian) {
  double* values = matrix_.valuePtr();
  if (base_.size() > 0) Eigen::Map<Vector>(values, base_.size()) = base_;
  for (const auto* slots : {&slots_, &mirrored_}) {
    const double* value = jacobian.valuePtr();
    for (const int slot : *slots) values[slot] = *value++;
  }
}

Layout SaddleMatrix::layout() const {
  return {base_.size() > 0 ? &matrix_ : nullptr, triangle_, unknowns()};
}

}  // namespace mbs::eigen_sparse
