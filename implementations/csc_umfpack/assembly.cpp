// The product with M, and the values of T.
#include "assembly.hpp"

#include <algorithm>

namespace mbs::csc_umfpack {

MassMatrix::MassMatrix(const Model& model)
    : pattern_(mass_pattern(model)), values_(pattern_.rows.size()) {
  for (const auto& entry : model.mass()) {
    values_[pattern_.position(entry.row, entry.col)] = entry.value;
    values_[pattern_.position(entry.col, entry.row)] = entry.value;
  }
}

void MassMatrix::residual(const double* x, const double* Q, double scale, double* y) const {
  const int n = pattern_.variables();
  const int *starts = pattern_.starts.data(), *rows = pattern_.rows.data();
  const double* M = values_.data();
  for (int i = 0; i < n; ++i) {  // column i is row i
    double sum = Q[i];
    for (int k = starts[i]; k < starts[i + 1]; ++k) sum -= M[k] * x[rows[k]];
    y[i] = scale * sum;
  }
}

template <int D>
Tangent<D>::Tangent(const MassMatrix& mass, const JacobianLayout& layout, const ForceLayout& forces,
                    double factor)
    : schedule_(mass.pattern(), layout, forces),
      factor_(factor),
      values_(schedule_.pattern.rows.size(), 0.0) {
  const SparsityPattern &M = mass.pattern(), &T = schedule_.pattern;
  for (int col = 0; col < M.variables(); ++col) {
    int position = T.starts[col];
    for (int k = M.starts[col]; k < M.starts[col + 1]; ++k) {
      while (T.rows[position] != M.rows[k]) ++position;
      values_[position] = mass.values()[k];
    }
  }
  for (const auto& linear : layout.linears) {
    const auto terms = std::span(layout.terms).subspan(linear.first, linear.last - linear.first);
    for (const auto& col : terms) {
      for (const auto& row : terms) {
        values_[T.position(row.coordinate, col.coordinate)] +=
            factor * (row.coefficient * col.coefficient);
      }
    }
  }
  for (const auto* blocks : {&schedule_.diagonal, &schedule_.lower}) {
    for (const auto& block : *blocks) {
      for (int i = 0; i < D; ++i) {
        for (int j = 0; j < D; ++j) constant_.push_back(values_[block.place.position[j] + i]);
      }
    }
  }
}

template <int D>
void Tangent<D>::update(const Jacobian<D>& jacobian, const Forces<D>& forces) {
  const double* J = jacobian.values();
  const double* constant = constant_.data();
  const auto* pairs = schedule_.pairs.data();
  double* T = values_.data();
  double sum[D][D];
  const auto add_up = [&](const auto& block) {
    std::fill_n(&sum[0][0], D * D, 0.0);
    for (int p = block.first; p < block.last; ++p) {
      const double *row = J + D * pairs[p].row, *col = J + D * pairs[p].col;
      for (int i = 0; i < D; ++i) {
        for (int j = 0; j < D; ++j) sum[i][j] += row[i] * col[j];
      }
    }
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) sum[i][j] = *constant++ + factor_ * sum[i][j];  // Eq. (5)
    }
  };
  for (const auto& block : schedule_.diagonal) {
    add_up(block);
    for (int i = 0; i < D; ++i) std::copy_n(sum[i], D, T + block.place.mirrored[i]);
  }
  for (const auto& block : schedule_.lower) {
    add_up(block);
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) T[block.place.position[j] + i] = sum[i][j];
      std::copy_n(sum[i], D, T + block.place.mirrored[i]);
    }
  }
  forces.add_tangent(schedule_.places, T);
}

template class Tangent<2>;
template class Tangent<3>;

}  // namespace mbs::csc_umfpack
