// Phi, the Jacobian Phi_q and the products with it, streamed through recorded positions.
#include "jacobian.hpp"

#include <algorithm>
#include <array>

#include "point_vector.hpp"

namespace mbs::csc_klu {
namespace {

void add_scaled(double factor, const Both& x, Both& y) {
  for (int i = 0; i < 2; ++i) y[i] += factor * x[i];
}

}  // namespace

template <int dim>
Jacobian<dim>::Jacobian(const JacobianPattern<dim>& pattern)
    : pattern_(pattern), values_(dim * (pattern.blocks() + 1), 0.0) {}

template <int dim>
void Jacobian<dim>::evaluate(const double* q, double* phi) {
  for (const auto& distance : pattern_.distances) {
    const Vector<dim> d = difference<dim>(q, distance.a, distance.b);
    *phi++ = dot(d, d) - distance.value;  // Eq. (7)
    double* const at_a = values_.data() + dim * distance.block_a;
    double* const at_b = values_.data() + dim * distance.block_b;
    for (int k = 0; k < dim; ++k) at_a[k] = 2.0 * d[k];   // Eq. (7)
    for (int k = 0; k < dim; ++k) at_b[k] = -2.0 * d[k];  // Eq. (7)
  }
  const auto* const terms = pattern_.terms.data();
  const auto* term = terms;
  const auto write_blocks = [&](int terms_end, const Vector<dim>& Bw, const Vector<dim>& Bu) {
    for (; term < terms + terms_end; ++term) {
      double* const value = values_.data() + dim * term->block;
      for (int k = 0; k < dim; ++k) value[k] = term->first * Bw[k] + term->second * Bu[k];
    }
  };
  for (const auto& other : pattern_.dots) {
    const Vector<dim> u = difference<dim>(q, other.a, other.b);
    const Vector<dim> w = difference<dim>(q, other.c, other.d);
    *phi++ = dot(u, w) - other.value;     // Eq. (7)
    write_blocks(other.terms_end, w, u);  // Eq. (7)
  }
  for (const auto& bilinear : pattern_.bilinears) {
    const Vector<dim> u = difference<dim>(q, bilinear.a, bilinear.b);
    const Vector<dim> Bw = product(bilinear.B, difference<dim>(q, bilinear.c, bilinear.d));
    *phi++ = dot(u, Bw) - bilinear.value;                                     // Eq. (7)
    write_blocks(bilinear.terms_end, Bw, transposed_product(bilinear.B, u));  // Eq. (7)
  }
  int k = 0;
  for (const auto& linear : pattern_.linears) {
    double sum = 0.0;
    for (; k < linear.terms_end; ++k) {
      sum += pattern_.linear_terms[k].coefficient * q[pattern_.linear_terms[k].coordinate];
    }
    *phi++ = sum - linear.value;  // Eq. (8)
  }
}

template <int dim>
void Jacobian<dim>::multiply(const double* v, const double* a, Both* z) const {
  std::fill_n(z, pattern_.quadratics(), Both{});
  const int* const row = pattern_.block_row.data();
  const double* value = values_.data();
  int block = 0;
  for (int p = 0; p < pattern_.points(); ++p) {
    std::array<Both, dim> x;
    for (int k = 0; k < dim; ++k) x[k] = {v[dim * p + k], a[dim * p + k]};
    for (const int end = pattern_.block_begin[p + 1]; block < end; ++block, value += dim) {
      Both sum = z[row[block]];
      for (int k = 0; k < dim; ++k) add_scaled(value[k], x[k], sum);
      z[row[block]] = sum;
    }
  }
  z += pattern_.quadratics();
  int k = 0;
  for (const auto& linear : pattern_.linears) {
    Both sum{};
    for (; k < linear.terms_end; ++k) {
      const auto& [coordinate, coefficient] = pattern_.linear_terms[k];
      add_scaled(coefficient, {v[coordinate], a[coordinate]}, sum);
    }
    *z++ = sum;  // Eq. (8)
  }
}

template <int dim>
void Jacobian<dim>::multiply_transposed(const Both* z, double factor, double* y_v,
                                        double* y_a) const {
  const int* const row = pattern_.block_row.data();
  const double* value = values_.data();
  int block = 0;
  for (int p = 0; p < pattern_.points(); ++p) {
    std::array<Both, dim> sum{};
    for (const int end = pattern_.block_begin[p + 1]; block < end; ++block, value += dim) {
      for (int k = 0; k < dim; ++k) add_scaled(value[k], z[row[block]], sum[k]);
    }
    for (int k = 0; k < dim; ++k) y_v[dim * p + k] = factor * sum[k][0];
    for (int k = 0; k < dim; ++k) y_a[dim * p + k] = factor * sum[k][1];
  }
  z += pattern_.quadratics();
  int k = 0;
  for (const auto& linear : pattern_.linears) {
    for (; k < linear.terms_end; ++k) {
      const auto& [coordinate, coefficient] = pattern_.linear_terms[k];
      y_v[coordinate] += factor * coefficient * (*z)[0];
      y_a[coordinate] += factor * coefficient * (*z)[1];
    }
    ++z;
  }
}

template <int dim>
void Jacobian<dim>::subtract_transposed_quadratics(const double* z, double* y) const {
  const int* const row = pattern_.block_row.data();
  const double* value = values_.data();
  int block = 0;
  for (int p = 0; p < pattern_.points(); ++p, y += dim) {
    std::array<double, dim> sum{};
    for (const int end = pattern_.block_begin[p + 1]; block < end; ++block, value += dim) {
      for (int k = 0; k < dim; ++k) sum[k] += z[row[block]] * value[k];
    }
    for (int k = 0; k < dim; ++k) y[k] -= sum[k];
  }
}

template <int dim>
void Jacobian<dim>::subtract_transposed_product(const double* z, double* y) const {
  subtract_transposed_quadratics(z, y);
  z += pattern_.quadratics();
  int k = 0;
  for (const auto& linear : pattern_.linears) {
    for (; k < linear.terms_end; ++k) {
      y[pattern_.linear_terms[k].coordinate] -= pattern_.linear_terms[k].coefficient * *z;
    }
    ++z;
  }
}

template <int dim>
void Jacobian<dim>::velocity_term(const double* v, double factor, double* z) const {
  for (const auto& distance : pattern_.distances) {
    const Vector<dim> d = difference<dim>(v, distance.a, distance.b);
    *z++ = factor * (2.0 * dot(d, d));  // Eq. (7)
  }
  for (const auto& other : pattern_.dots) {
    const Vector<dim> u = difference<dim>(v, other.a, other.b);
    *z++ = factor * (2.0 * dot(u, difference<dim>(v, other.c, other.d)));  // Eq. (7)
  }
  for (const auto& bilinear : pattern_.bilinears) {
    const Vector<dim> u = difference<dim>(v, bilinear.a, bilinear.b);
    const Vector<dim> w = difference<dim>(v, bilinear.c, bilinear.d);
    *z++ = factor * (2.0 * dot(u, product(bilinear.B, w)));  // Eq. (7)
  }
}

template <int dim>
void Jacobian<dim>::add_rates(const double* q, const double* x, double* z) const {
  for (const auto& distance : pattern_.distances) {
    const Vector<dim> d = difference<dim>(q, distance.a, distance.b);
    *z++ += 2.0 * dot(d, difference<dim>(x, distance.a, distance.b));  // Eq. (7)
  }
  for (const auto& other : pattern_.dots) {
    const Vector<dim> u = difference<dim>(q, other.a, other.b);
    const Vector<dim> w = difference<dim>(q, other.c, other.d);
    *z++ += dot(difference<dim>(x, other.a, other.b), w) +
            dot(u, difference<dim>(x, other.c, other.d));  // Eq. (7)
  }
  for (const auto& bilinear : pattern_.bilinears) {
    const Vector<dim> u = difference<dim>(q, bilinear.a, bilinear.b);
    const Vector<dim> w = difference<dim>(q, bilinear.c, bilinear.d);
    const Vector<dim> u_x = difference<dim>(x, bilinear.a, bilinear.b);
    const Vector<dim> w_x = difference<dim>(x, bilinear.c, bilinear.d);
    *z++ += dot(u_x, product(bilinear.B, w)) + dot(u, product(bilinear.B, w_x));  // Eq. (7)
  }
  int k = 0;
  for (const auto& linear : pattern_.linears) {
    for (; k < linear.terms_end; ++k) {
      *z += pattern_.linear_terms[k].coefficient * x[pattern_.linear_terms[k].coordinate];
    }
    ++z;  // Eq. (8)
  }
}

template class Jacobian<2>;
template class Jacobian<3>;

}  // namespace mbs::csc_klu
