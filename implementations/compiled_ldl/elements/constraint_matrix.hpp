// Constraints: what they add to the matrix of Eqs. (5), (12) and (14). Part of constraints.hpp.
#pragma once

#include "elements/constraints.hpp"

namespace mbs::compiled_ldl {

template <typename S, int D>
template <typename F>
void Constraints<S, D>::add_constant(F* matrix, const S& s) const {
  for (std::size_t i = 0; i < term_places_.size(); ++i) {
    matrix[term_places_[i]] += static_cast<F>(term_coefficients_[i]);
  }
  for (const Product& product : products_) {
    matrix[product.at] +=
        static_cast<F>(s * term_coefficients_[product.one] * term_coefficients_[product.other]);
  }
}

template <typename S, int D>
template <typename F>
void Constraints<S, D>::add_penalty(F* matrix, const S& s) const {
  const S s4 = s * S(4.0);  // two factors 2 of Φq
  const S* u = u_.data();
  int k = 0;
  for (; k < pairs_.two; ++k, u += D) add_pair<D>(matrix, pairs_.list[k], 2, s4, u);
  for (; k < pairs_.one; ++k, u += D) add_pair<D>(matrix, pairs_.list[k], 1, s4, u);
  const S* vectors = vectors_.data();
  for (const Quad& quad : quads_) {
    add_quad<D>(matrix, quad, places_.data(), s, vectors + 2 * D);
    vectors += kQuad;
  }
}

template <typename S, int D>
template <typename F>
void Constraints<S, D>::add_rows(F* matrix) const {
  for (int k = 0; k < pairs_.one; ++k) {
    const S* u = u_.data() + k * D;
    const RowPlace& place = pair_rows_[k];
    for (int x = 0; x < D; ++x) {
      const F g = static_cast<F>(u[x] + u[x]);
      matrix[place.a.at + x * place.a.stride] += g;
      if (k < pairs_.two) matrix[place.b.at + x * place.b.stride] -= g;
    }
  }
  for (std::size_t k = 0; k < quads_.size(); ++k) {
    const S* g = vectors_.data() + k * kQuad + 2 * D;
    for (int i = 0; i < quads_[k].free; ++i) {
      const Place& place = quad_rows_[4 * k + i];
      for (int x = 0; x < D; ++x) {
        matrix[place.at + x * place.stride] += static_cast<F>(g[i * D + x]);
      }
    }
  }
}

template <typename S, int D>
void Constraints<S, D>::keep_forces(const S* g, const S& h) {
  for (int k = 0; k < count(); ++k) force_[k] = g[k] * h;
}

template <typename S, int D>
template <typename F>
void Constraints<S, D>::add_curvature(F* matrix) const {
  for (int k = 0; k < pairs_.one; ++k) {
    add_pair_identity<D>(matrix, pairs_.list[k], pairs_.free(k), S(2.0) * force_[k]);
  }
  for (std::size_t k = 0; k < quads_.size(); ++k) {
    const Quad& quad = quads_[k];
    const S g = force_[pairs_.count() + k];
    const Place* place = places_.data() + quad.places;
    const S* B = matrix_of_quad_[k] < 0 ? nullptr : matrices_.data() + matrix_of_quad_[k];
    for (int i = 0; i < quad.free; ++i) {
      for (int j = i; j < quad.free; ++j, ++place) {
        // Block of rows j and columns i: σ_A,j σ_C,i B + σ_C,j σ_A,i Bᵀ, Eq. (16).
        const S one = g * S(quad.points[j].sign_a * quad.points[i].sign_c);
        const S other = g * S(quad.points[j].sign_c * quad.points[i].sign_a);
        for (int x = 0; x < D; ++x) {
          for (int y = i == j ? x : 0; y < D; ++y) {
            const S value = B != nullptr ? one * B[y * D + x] + other * B[x * D + y]
                            : x == y     ? one + other
                                         : S(0.0);
            matrix[place->at + x * place->stride + y] += static_cast<F>(value);
          }
        }
      }
    }
  }
}

template <typename S, int D>
void Constraints<S, D>::add_curvature_product(const S* x, S* y) const {
  for (int k = 0; k < pairs_.count(); ++k) {
    const Pair& pair = pairs_.list[k];
    const S s = S(2.0) * force_[k];
    for (int i = 0; i < D; ++i) {
      const S t = s * (x[pair.a + i] - x[pair.b + i]);
      y[pair.a + i] += t;
      y[pair.b + i] -= t;
    }
  }
  for (std::size_t k = 0; k < quads_.size(); ++k) {
    const Quad& quad = quads_[k];
    const S g = force_[pairs_.count() + k];
    S u[D], w[D], at_a[D], at_c[D];
    for (int i = 0; i < D; ++i) u[i] = at_c[i] = g * (x[quad.a + i] - x[quad.b + i]);
    for (int i = 0; i < D; ++i) w[i] = at_a[i] = g * (x[quad.c + i] - x[quad.d + i]);
    if (matrix_of_quad_[k] >= 0) {
      multiply(matrices_.data() + matrix_of_quad_[k], w, at_a, false);
      multiply(matrices_.data() + matrix_of_quad_[k], u, at_c, true);
    }
    for (int i = 0; i < D; ++i) {
      y[quad.a + i] += at_a[i];
      y[quad.b + i] -= at_a[i];
      y[quad.c + i] += at_c[i];
      y[quad.d + i] -= at_c[i];
    }
  }
}

}  // namespace mbs::compiled_ldl
