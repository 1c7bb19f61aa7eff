// Phi, the Jacobian Phi_q and the products with it, streamed through recorded positions.
#include "jacobian.hpp"

#include <array>

#include "point_vector.hpp"

namespace mbs::csc_klu {

template <int dim>
Jacobian<dim>::Jacobian(const JacobianPattern<dim>& pattern)
    : pattern_(pattern), values_(dim * (pattern.blocks() + 1), 0.0) {}

template <int dim>
void Jacobian<dim>::evaluate(const double* q, double* phi) {
  sweep<true>(q, phi);
}

template <int dim>
void Jacobian<dim>::evaluate_phi(const double* q, double* phi) {
  sweep<false>(q, phi);
}

template <int dim>
template <bool with_jacobian>
void Jacobian<dim>::sweep(const double* q, double* phi) {
  for (const auto& distance : pattern_.distances) {
    const Vector<dim> d = difference<dim>(q, distance.a, distance.b);
    *phi++ = dot(d, d) - distance.value;  // Eq. (7)
    if (!with_jacobian) continue;
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
    *phi++ = dot(u, w) - other.value;                        // Eq. (7)
    if (with_jacobian) write_blocks(other.terms_end, w, u);  // Eq. (7)
  }
  for (const auto& bilinear : pattern_.bilinears) {
    const Vector<dim> u = difference<dim>(q, bilinear.a, bilinear.b);
    const Vector<dim> Bw = product(bilinear.B, difference<dim>(q, bilinear.c, bilinear.d));
    *phi++ = dot(u, Bw) - bilinear.value;  // Eq. (7)
    if (!with_jacobian) continue;
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
void Jacobian<dim>::multiply_transposed(const double* z, double factor, double* y) const {
  sweep_transposed<false>(z, factor, y);
}

template <int dim>
void Jacobian<dim>::subtract_transposed_product(const double* z, double factor, double* y) const {
  sweep_transposed<true>(z, -factor, y);
}

template <int dim>
template <bool adds>
void Jacobian<dim>::sweep_transposed(const double* __restrict z, double factor,
                                     double* __restrict y) const {
  const int* const row = pattern_.block_row.data();
  const double* value = values_.data();
  int block = 0;
  for (int p = 0; p < pattern_.points(); ++p) {
    std::array<double, dim> sum{};
    for (const int end = pattern_.block_begin[p + 1]; block < end; ++block, value += dim) {
      for (int k = 0; k < dim; ++k) sum[k] += z[row[block]] * value[k];
    }
    double* const at = y + dim * p;
    for (int k = 0; k < dim; ++k) at[k] = adds ? at[k] + factor * sum[k] : factor * sum[k];
  }
  z += pattern_.quadratics();
  int k = 0;
  for (const auto& linear : pattern_.linears) {
    const double scaled = factor * *z++;
    for (; k < linear.terms_end; ++k) {
      y[pattern_.linear_terms[k].coordinate] += pattern_.linear_terms[k].coefficient * scaled;
    }
  }
}

template <int dim>
void Jacobian<dim>::rates(const double* q, const double* v, double* z) const {
  differentiate<true, false>(q, v, nullptr, z);
}

template <int dim>
void Jacobian<dim>::second_rates(const double* q, const double* v, const double* a,
                                 double* z) const {
  differentiate<true, true>(q, a, v, z);
}

template <int dim>
void Jacobian<dim>::velocity_term(const double* v, double* z) const {
  differentiate<false, true>(nullptr, nullptr, v, z);
}

template <int dim>
template <bool with_rates, bool with_squares>
void Jacobian<dim>::differentiate(const double* q, const double* x, const double* v,
                                  double* z) const {
  for (const auto& distance : pattern_.distances) {
    const auto d = [&](const double* of) { return difference<dim>(of, distance.a, distance.b); };
    double sum = 0.0;
    if (with_rates) sum += dot(d(q), d(x));
    if (with_squares) sum += dot(d(v), d(v));
    *z++ = 2.0 * sum;  // Eq. (7)
  }
  for (const auto& other : pattern_.dots) {
    const auto u = [&](const double* of) { return difference<dim>(of, other.a, other.b); };
    const auto w = [&](const double* of) { return difference<dim>(of, other.c, other.d); };
    double sum = 0.0;
    if (with_rates) sum += dot(u(x), w(q)) + dot(u(q), w(x));
    if (with_squares) sum += 2.0 * dot(u(v), w(v));
    *z++ = sum;  // Eq. (7)
  }
  for (const auto& bilinear : pattern_.bilinears) {
    const auto u = [&](const double* of) { return difference<dim>(of, bilinear.a, bilinear.b); };
    const auto Bw = [&](const double* of) {
      return product(bilinear.B, difference<dim>(of, bilinear.c, bilinear.d));
    };
    double sum = 0.0;
    if (with_rates) sum += dot(u(x), Bw(q)) + dot(u(q), Bw(x));
    if (with_squares) sum += 2.0 * dot(u(v), Bw(v));
    *z++ = sum;  // Eq. (7)
  }
  int k = 0;
  for (const auto& linear : pattern_.linears) {
    double sum = 0.0;
    for (; k < linear.terms_end; ++k) {
      const auto& [coordinate, coefficient] = pattern_.linear_terms[k];
      if (with_rates) sum += coefficient * x[coordinate];
    }
    *z++ = sum;  // Eq. (8)
  }
}

template class Jacobian<2>;
template class Jacobian<3>;

}  // namespace mbs::csc_klu
