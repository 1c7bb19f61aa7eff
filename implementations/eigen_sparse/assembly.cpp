// Set-up and refresh of the tangent matrix.
#include "assembly.hpp"

namespace mbs::eigen_sparse {

Tangent::Tangent(const Model& model, const Coordinates& coordinates, const Constraints& constraints,
                 Triangle triangle, double penalty)
    : triangle_(triangle), penalty_(penalty), matrix_(tangent_pattern(model, coordinates)) {
  if (triangle == Triangle::upper) matrix_ = SparseMatrix(matrix_.triangularView<Eigen::Upper>());
  make_runs(constraints);
  add_linear_rows(constraints);
  base_ = Eigen::Map<const Vector>(matrix_.valuePtr(), matrix_.nonZeros());
}

/// Slots and runs of the rows that change.
void Tangent::make_runs(const Constraints& constraints) {
  const RowSparseMatrix& jacobian = constraints.jacobian();
  const int* starts = jacobian.outerIndexPtr();
  int run_width = 0;
  for (int row = 0; row < constraints.quadratic(); ++row) {
    const int width = starts[row + 1] - starts[row];
    if (width == 0) continue;
    if (width != run_width) {
      runs_.push_back(
          {loop_for(triangle_, width), starts[row], static_cast<int>(slots_.size()), 0});
      run_width = width;
    }
    ++runs_.back().count;
    append_slots(layout(),
                 {jacobian.innerIndexPtr() + starts[row], static_cast<std::size_t>(width)}, slots_);
  }
}

/// The share of the linear constraints, once and for all.
void Tangent::add_linear_rows(const Constraints& constraints) {
  const RowSparseMatrix& jacobian = constraints.jacobian();
  const int* starts = jacobian.outerIndexPtr();
  std::vector<int> slots;
  for (int row = constraints.quadratic(); row < jacobian.rows(); ++row) {
    const std::span columns(jacobian.innerIndexPtr() + starts[row],
                            jacobian.innerIndexPtr() + starts[row + 1]);
    const double* values = jacobian.valuePtr() + starts[row];
    slots.clear();
    append_slots(layout(), columns, slots);
    const int* slot = slots.data();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::size_t end = triangle_ == Triangle::full ? columns.size() : i + 1;
      for (std::size_t j = 0; j < end; ++j) {
        matrix_.valuePtr()[*slot++] += penalty_ * values[i] * values[j];  // Eq. (5)
      }
    }
  }
}

void Tangent::refresh(const RowSparseMatrix& jacobian) {
  Eigen::Map<Vector>(matrix_.valuePtr(), base_.size()) = base_;
  for (const Run& run : runs_) {  // Eq. (5)
    run.add(jacobian.valuePtr() + run.first_value, slots_.data() + run.first_slot, run.count,
            penalty_, matrix_.valuePtr());
  }
}

}  // namespace mbs::eigen_sparse
