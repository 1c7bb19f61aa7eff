// Phi, Phi_q, the products with M and Phi_q, and the values of T.
#include "assembly.hpp"

#include <algorithm>

namespace mbs::csc_umfpack {
namespace {

/// u = x_a - x_b (D) for offsets a and b; returns |u|^2.
template <int D>
double squared_difference(const double* x, int a, int b, double (&u)[D]) {
  double sum = 0.0;
  for (int k = 0; k < D; ++k) {
    u[k] = x[a + k] - x[b + k];
    sum += u[k] * u[k];
  }
  return sum;
}

}  // namespace

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

void MassMatrix::multiply(const double* x, const double* x2, double* y, double* y2) const {
  const int n = pattern_.variables();
  const int *starts = pattern_.starts.data(), *rows = pattern_.rows.data();
  const double* M = values_.data();
  for (int i = 0; i < n; ++i) {
    double sum = 0.0, sum2 = 0.0;
    for (int k = starts[i]; k < starts[i + 1]; ++k) {
      sum += M[k] * x[rows[k]];
      sum2 += M[k] * x2[rows[k]];
    }
    y[i] = sum;
    y2[i] = sum2;
  }
}

template <int D>
void Jacobian<D>::evaluate(const double* x, double* Phi) {
  double* J = values_.data();
  double u[D];
  for (const auto& pin : layout_.pins) {
    *Phi++ = squared_difference(x, pin.a, pin.b, u) - pin.value;  // Eq. (7)
    for (int k = 0; k < D; ++k) J[k] = 2.0 * u[k];
    J += D;
  }
  for (const auto& link : layout_.links) {
    *Phi++ = squared_difference(x, link.a, link.b, u) - link.value;  // Eq. (7)
    for (int k = 0; k < D; ++k) {
      J[k] = 2.0 * u[k];
      J[D + k] = -2.0 * u[k];
    }
    J += 2 * D;
  }
  Phi = evaluate_dots(x, Phi, J);
  for (const auto& linear : layout_.linears) {
    double sum = -linear.value;
    for (int t = linear.first; t < linear.last; ++t) {
      sum += layout_.terms[t].coefficient * x[layout_.terms[t].coordinate];
    }
    *Phi++ = sum;  // Eq. (8)
  }
}

template <int D>
double* Jacobian<D>::evaluate_dots(const double* x, double* Phi, double* J) const {
  const auto* signs = layout_.dot_signs.data();
  for (const auto& dot : layout_.dots) {
    double ab[D], cd[D], sum = -dot.value;
    for (int k = 0; k < D; ++k) {
      ab[k] = x[dot.a + k] - x[dot.b + k];
      cd[k] = x[dot.c + k] - x[dot.d + k];
      sum += ab[k] * cd[k];
    }
    *Phi++ = sum;  // Eq. (7)
    for (int block = dot.first; block < dot.last; ++block, ++signs, J += D) {
      for (int k = 0; k < D; ++k) J[k] = signs->of_cd * cd[k] + signs->of_ab * ab[k];
    }
  }
  return Phi;
}

template <int D>
void Jacobian<D>::velocity_term(const double* v, double factor, double* y) const {
  const double twice = 2.0 * factor;
  for (const auto* rows : {&layout_.pins, &layout_.links}) {
    for (const auto& row : *rows) {
      double u[D];
      *y++ = twice * squared_difference(v, row.a, row.b, u);  // Eq. (7)
    }
  }
  for (const auto& dot : layout_.dots) {
    double sum = 0.0;
    for (int k = 0; k < D; ++k) {
      sum += (v[dot.a + k] - v[dot.b + k]) * (v[dot.c + k] - v[dot.d + k]);
    }
    *y++ = twice * sum;  // Eq. (7)
  }
  std::fill_n(y, layout_.linears.size(), 0.0);  // Eq. (8)
}

template <int D>
void Jacobian<D>::subtract_transpose_product(const double* z, double* y) const {
  const double* J = values_.data();
  for (const auto& block : layout_.blocks) {
    const double factor = z[block.row];
    for (int k = 0; k < D; ++k) y[block.offset + k] -= factor * J[k];
    J += D;
  }
  z += layout_.order.size() - layout_.linears.size();
  for (const auto& linear : layout_.linears) {
    for (int t = linear.first; t < linear.last; ++t) {
      y[layout_.terms[t].coordinate] -= *z * layout_.terms[t].coefficient;
    }
    ++z;
  }
}

template <int D>
Tangent<D>::Tangent(const MassMatrix& mass, const JacobianLayout& layout, double factor)
    : schedule_(mass.pattern(), layout),
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
        for (int j = 0; j < D; ++j) constant_.push_back(values_[block.position[j] + i]);
      }
    }
  }
}

template <int D>
void Tangent<D>::update(const Jacobian<D>& jacobian) {
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
    for (int i = 0; i < D; ++i) std::copy_n(sum[i], D, T + block.mirrored[i]);
  }
  for (const auto& block : schedule_.lower) {
    add_up(block);
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) T[block.position[j] + i] = sum[i][j];
      std::copy_n(sum[i], D, T + block.mirrored[i]);
    }
  }
}

template class Jacobian<2>;
template class Jacobian<3>;
template class Tangent<2>;
template class Tangent<3>;

}  // namespace mbs::csc_umfpack
