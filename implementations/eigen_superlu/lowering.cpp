// Set-up of an Assembly: constraints sorted by kind, patterns and slots.
#include <algorithm>
#include <numeric>

#include "assembly.hpp"

namespace mbs::eigen_superlu {
namespace {

bool is_distance(const Coordinates& coordinates, const DotConstraint& constraint) {
  return constraint.a == constraint.c && constraint.b == constraint.d &&
         constraint.a != constraint.b &&
         (coordinates.is_free(constraint.a) || coordinates.is_free(constraint.b));
}

/// Where entry (row, col) is in the arrays of `matrix`.
int slot_of(const SparseMatrix& matrix, int row, int col) {
  const int* rows = matrix.innerIndexPtr();
  const int* first = rows + matrix.outerIndexPtr()[col];
  const int* last = rows + matrix.outerIndexPtr()[col + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - rows);
}

struct Product {
  int i, j, slot;
};

/// Where r^T r goes for a row r of Phi_q with `width` entries in `columns`, ordered for add_rows().
std::vector<Product> products_of_row(const SparseMatrix& tangent, Triangle triangle,
                                     const int* columns, int width) {
  std::vector<Product> products;
  for (int i = 0; i < width; ++i) {
    for (int j = 0; j < (triangle == Triangle::full ? width : i + 1); ++j) {
      const auto [low, high] = std::minmax(columns[i], columns[j]);
      const bool full = triangle == Triangle::full;
      products.push_back(
          {i, j, slot_of(tangent, full ? columns[i] : low, full ? columns[j] : high)});
    }
  }
  return products;
}

}  // namespace

Assembly::Assembly(const Model& model, const Coordinates& coordinates, Triangle triangle,
                   double penalty)
    : dimension_(model.dimension()),
      order_(model.constraints()),
      value_(model.constraints()),
      phi_(Vector::Zero(model.constraints())),
      penalty_(penalty),
      tangent_(tangent_pattern(model, coordinates)) {
  if (triangle == Triangle::upper) tangent_ = SparseMatrix(tangent_.triangularView<Eigen::Upper>());
  const auto dots = model.dot_constraints();
  const auto linear = model.linear_constraints();
  const auto kind = [&](int k) {
    const auto free = free_points(coordinates, dots[k]).size();
    return is_distance(coordinates, dots[k]) ? free : 3 + free;
  };
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.begin() + dots.size(),
                   [&](int k, int l) { return kind(k) < kind(l); });
  for (std::size_t row = 0; row < order_.size(); ++row) {
    if (row >= dots.size()) {
      value_[row] = linear[order_[row] - dots.size()].value;
      continue;
    }
    const DotConstraint& constraint = dots[order_[row]];
    value_[row] = constraint.value;
    if (is_distance(coordinates, constraint)) {
      add_distance(coordinates, constraint);
    } else {
      add_dot(coordinates, constraint);
    }
  }
  make_jacobian(model, coordinates);
  make_runs(triangle);
}

void Assembly::add_distance(const Coordinates& coordinates, const DotConstraint& constraint) {
  const bool free = coordinates.is_free(constraint.a) && coordinates.is_free(constraint.b);
  const bool swapped = !coordinates.is_free(constraint.a);
  for (const int point :
       {swapped ? constraint.b : constraint.a, swapped ? constraint.a : constraint.b}) {
    for (int axis = 0; axis < dimension_; ++axis) {
      ends_.push_back(coordinates.of_point(point, axis));
    }
  }
  to_ground_ += free ? 0 : 1;
  quadratic_ = ++distances_;
}

void Assembly::add_dot(const Coordinates& coordinates, const DotConstraint& constraint) {
  Dot dot;
  for (const int point : free_points(coordinates, constraint)) {
    dot.weights[2 * dot.free_points] = (point == constraint.a) - (point == constraint.b);
    dot.weights[2 * dot.free_points + 1] = (point == constraint.c) - (point == constraint.d);
    ++dot.free_points;
  }
  int* end = dot.ends;
  for (const int point : {constraint.a, constraint.b, constraint.c, constraint.d}) {
    for (int axis = 0; axis < dimension_; ++axis) *end++ = coordinates.of_point(point, axis);
  }
  dots_.push_back(dot);
  ++quadratic_;
}

/// Columns of a row stay in the order of its points, which Eigen's products with vectors allow but
/// its copies of sparse matrices do not: hence the arrays are filled directly.
void Assembly::make_jacobian(const Model& model, const Coordinates& coordinates) {
  const auto dots = model.dot_constraints();
  std::vector<int> starts{0}, columns;
  for (int row = 0; row < quadratic_; ++row) {
    for (const int point : free_points(coordinates, dots[order_[row]])) {
      for (int axis = 0; axis < dimension_; ++axis) {
        columns.push_back(coordinates.of_point(point, axis));
      }
    }
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

/// Rows that change get slots and runs; those of linear constraints are added once and for all.
void Assembly::make_runs(Triangle triangle) {
  const int* starts = jacobian_.outerIndexPtr();
  int run_width = 0;
  for (int row = 0; row < jacobian_.rows(); ++row) {
    const int width = starts[row + 1] - starts[row];
    const auto products =
        products_of_row(tangent_, triangle, jacobian_.innerIndexPtr() + starts[row], width);
    if (row >= quadratic_) {
      const double* values = jacobian_.valuePtr() + starts[row];
      for (const Product& at : products) {
        tangent_.valuePtr()[at.slot] += penalty_ * values[at.i] * values[at.j];
      }
    } else if (width > 0) {
      if (width != run_width) {
        runs_.push_back({triangle == Triangle::full ? loop_for<Triangle::full>(width)
                                                    : loop_for<Triangle::upper>(width),
                         starts[row], static_cast<int>(slots_.size()), 0});
        run_width = width;
      }
      ++runs_.back().count;
      for (const Product& at : products) slots_.push_back(at.slot);
    }
  }
  base_ = Eigen::Map<const Vector>(tangent_.valuePtr(), tangent_.nonZeros());
}

}  // namespace mbs::eigen_superlu
