// Set-up of Constraints: sorting by kind, the pattern of Phi_q.
#include <algorithm>
#include <numeric>
#include <utility>

#include "constraints.hpp"

namespace mbs::eigen_sparse {
namespace {

bool is_distance(const Coordinates& coordinates, const DotConstraint& constraint) {
  return constraint.a == constraint.c && constraint.b == constraint.d &&
         constraint.a != constraint.b &&
         (coordinates.is_free(constraint.a) || coordinates.is_free(constraint.b));
}

/// What rows are sorted by: the kind, then the elimination of the first of their points. Rows next
/// to each other then seldom share a point, and need not wait for each other in products with
/// Phi_q^T.
std::pair<std::size_t, int> key_of(const Coordinates& coordinates, std::span<const int> ends,
                                   bool distance) {
  const std::vector<int> free = free_ones(coordinates, ends);
  int first = coordinates.variables();
  for (const int point : free) first = std::min(first, coordinates.of_point(point, 0));
  return {distance ? free.size() : 3 + free.size(), first};
}

/// Sorts first ... last of `order` by what `key` gives for them, computed once each.
template <class Key>
void sort_by(std::vector<int>& order, std::size_t first, std::size_t last, Key key) {
  std::vector<std::pair<std::size_t, int>> keys;
  for (std::size_t k = first; k < last; ++k) keys.push_back(key(k - first));
  std::stable_sort(order.begin() + first, order.begin() + last,
                   [&](int k, int l) { return keys[k - first] < keys[l - first]; });
}

/// The points of quadratic constraint `k` in the order of Phi.
std::array<int, 4> ends_of_quadratic(const Model& model, std::size_t k) {
  const auto dots = model.dot_constraints();
  return k < dots.size() ? ends_of(dots[k])
                         : ends_of(model.bilinear_constraints()[k - dots.size()]);
}

}  // namespace

Constraints::Constraints(const Model& model, const Coordinates& coordinates)
    : dimension_(model.dimension()),
      order_(model.constraints()),
      value_(model.constraints()),
      phi_(Vector::Zero(model.constraints())) {
  sort_rows(model, coordinates);
  make_jacobian(model, coordinates);
}

void Constraints::sort_rows(const Model& model, const Coordinates& coordinates) {
  const auto dots = model.dot_constraints();
  const auto bilinear = model.bilinear_constraints();
  const auto linear = model.linear_constraints();
  std::iota(order_.begin(), order_.end(), 0);
  sort_by(order_, 0, dots.size(), [&](std::size_t k) {
    return key_of(coordinates, ends_of(dots[k]), is_distance(coordinates, dots[k]));
  });
  sort_by(order_, dots.size(), dots.size() + bilinear.size(),
          [&](std::size_t k) { return key_of(coordinates, ends_of(bilinear[k]), false); });
  for (std::size_t row = 0; row < dots.size(); ++row) {
    const DotConstraint& constraint = dots[order_[row]];
    value_[row] = constraint.value;
    if (is_distance(coordinates, constraint)) {
      add_distance(coordinates, constraint);
    } else {
      dots_.push_back({coordinates, ends_of(constraint)});
    }
  }
  products_ = quadratic_ = static_cast<int>(dots.size());
  for (; quadratic_ < products_ + static_cast<int>(bilinear.size()); ++quadratic_) {
    const BilinearConstraint& constraint = bilinear[order_[quadratic_] - products_];
    value_[quadratic_] = constraint.value;
    bilinear_.push_back({{coordinates, ends_of(constraint)}, packed(constraint.B, dimension_)});
  }
  for (std::size_t k = 0; k < linear.size(); ++k) value_[quadratic_ + k] = linear[k].value;
}

void Constraints::add_distance(const Coordinates& coordinates, const DotConstraint& constraint) {
  const bool free = coordinates.is_free(constraint.a) && coordinates.is_free(constraint.b);
  const bool swapped = !coordinates.is_free(constraint.a);
  for (const int point :
       {swapped ? constraint.b : constraint.a, swapped ? constraint.a : constraint.b}) {
    for (int axis = 0; axis < dimension_; ++axis) {
      ends_.push_back(coordinates.of_point(point, axis));
    }
  }
  to_ground_ += free ? 0 : 1;
  ++distances_;
}

/// Columns of a row stay in the order of its points, which Eigen's products with vectors allow but
/// its copies of sparse matrices do not: hence the arrays are filled directly.
void Constraints::make_jacobian(const Model& model, const Coordinates& coordinates) {
  std::vector<int> starts{0}, columns;
  for (int row = 0; row < quadratic_; ++row) {
    append_columns(coordinates, ends_of_quadratic(model, order_[row]), columns);
    starts.push_back(static_cast<int>(columns.size()));
  }
  std::vector<double> values(columns.size());
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const auto& term : constraint.terms) {
      columns.push_back(coordinates.of_unknown(term.coordinate));
      values.push_back(term.coefficient);
    }
    starts.push_back(static_cast<int>(columns.size()));
  }
  jacobian_.resize(model.constraints(), coordinates.variables());
  jacobian_.resizeNonZeros(static_cast<int>(columns.size()));
  std::copy(starts.begin(), starts.end(), jacobian_.outerIndexPtr());
  std::copy(columns.begin(), columns.end(), jacobian_.innerIndexPtr());
  std::copy(values.begin(), values.end(), jacobian_.valuePtr());
}

}  // namespace mbs::eigen_sparse
