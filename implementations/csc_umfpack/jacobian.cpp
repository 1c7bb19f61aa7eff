// Phi and Phi_q, derivatives of Phi by time.
#include "jacobian.hpp"

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
  Phi = evaluate_products(x, Phi, J);
  for (const auto& row : layout_.linears) *Phi++ = sum(row, x) - row.value;  // Eq. (8)
}

template <int D>
double* Jacobian<D>::evaluate_products(const double* x, double* Phi, double* J) const {
  const auto* signs = layout_.signs.data();
  const auto write = [&](const auto& row, const Vector<D>& at_a, const Vector<D>& at_c) {
    for (int block = row.first; block < row.last; ++block, ++signs, J += D) {
      for (int k = 0; k < D; ++k) J[k] = signs->in_ab * at_a[k] + signs->in_cd * at_c[k];
    }
  };
  for (const auto& row : layout_.dots) {
    const Vector<D> u = difference<D>(x, row.a, row.b), w = difference<D>(x, row.c, row.d);
    *Phi++ = dot(u, w) - row.value;  // Eq. (7)
    write(row, w, u);
  }
  for (const auto& row : layout_.bilinears) {
    const Vector<D> u = difference<D>(x, row.a, row.b);
    const Vector<D> Bw = product(row.B, difference<D>(x, row.c, row.d));
    *Phi++ = dot(u, Bw) - row.value;  // Eq. (7)
    write(row, Bw, transposed_product(row.B, u));
  }
  return Phi;
}

template <int D>
void Jacobian<D>::rates(const double* x, const double* v, double* y) const {
  for (const auto* rows : {&layout_.pins, &layout_.links}) {
    for (const auto& row : *rows) {
      *y++ = 2.0 * dot(difference<D>(x, row.a, row.b), difference<D>(v, row.a, row.b));
    }
  }
  for (const auto& row : layout_.dots) {
    *y++ = dot(difference<D>(v, row.a, row.b), difference<D>(x, row.c, row.d)) +
           dot(difference<D>(x, row.a, row.b), difference<D>(v, row.c, row.d));
  }
  for (const auto& row : layout_.bilinears) {
    *y++ = dot(difference<D>(v, row.a, row.b), product(row.B, difference<D>(x, row.c, row.d))) +
           dot(difference<D>(x, row.a, row.b), product(row.B, difference<D>(v, row.c, row.d)));
  }
  for (const auto& row : layout_.linears) *y++ = sum(row, v);
}

template <int D>
void Jacobian<D>::second_rates(const double* x, const double* v, const double* a, double* y) const {
  rates(x, a, y);
  for (const auto* rows : {&layout_.pins, &layout_.links}) {
    for (const auto& row : *rows) {
      double u[D];
      *y++ += 2.0 * squared_difference(v, row.a, row.b, u);  // Eq. (7)
    }
  }
  for (const auto& row : layout_.dots) {
    *y++ += 2.0 * dot(difference<D>(v, row.a, row.b), difference<D>(v, row.c, row.d));  // Eq. (7)
  }
  for (const auto& row : layout_.bilinears) {
    const Vector<D> Bw = product(row.B, difference<D>(v, row.c, row.d));
    *y++ += 2.0 * dot(difference<D>(v, row.a, row.b), Bw);  // Eq. (7)
  }
}

template <int D>
double Jacobian<D>::sum(const JacobianLayout::Linear& row, const double* x) const {
  double sum = 0.0;
  for (int t = row.first; t < row.last; ++t) {
    sum += layout_.terms[t].coefficient * x[layout_.terms[t].coordinate];
  }
  return sum;
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

template class Jacobian<2>;
template class Jacobian<3>;

}  // namespace mbs::csc_umfpack
