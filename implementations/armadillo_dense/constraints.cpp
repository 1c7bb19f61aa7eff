// The constraints, lowered to flat arrays: Phi, Phi_q and the derivative of Phi_q times v.
#include "constraints.hpp"

#include <algorithm>

#include "kinematics.hpp"

namespace mbs::armadillo_dense {

using arma::uword;

namespace {

/// B w, or Bᵀ w.
template <int dimension, bool is_transposed>
Direction<dimension> product(const std::array<std::array<double, 3>, 3>& B,
                             const Direction<dimension>& w) {
  Direction<dimension> result{};
  for (int i = 0; i < dimension; ++i) {
    for (int j = 0; j < dimension; ++j) result[i] += (is_transposed ? B[j][i] : B[i][j]) * w[j];
  }
  return result;
}

}  // namespace

Constraints::Constraints(const Model& model, const Layout& layout)
    : layout_(layout),
      height_(layout.moving),
      quadratics_(
          static_cast<int>(model.dot_constraints().size() + model.bilinear_constraints().size())),
      values_(model.constraints()),
      phi_(model.constraints(), arma::fill::zeros),
      jacobian_(height_ * phi_.n_elem + uword(layout.dimension), arma::fill::zeros) {
  lower_dot_constraints(model);
  lower_bilinear_constraints(model);
  lower_linear_constraints(model);
}

void Constraints::lower_dot_constraints(const Model& model) {
  int row = 0;
  for (const DotConstraint& c : model.dot_constraints()) {
    if (c.a == c.c && c.b == c.d && c.a != c.b) {
      const int a = layout_.starts[c.a];
      const int b = layout_.starts[c.b];
      distances_.push_back({.row = row,
                            .a = a,
                            .b = b,
                            .grad_a = gradient_place(a, row),
                            .grad_b = gradient_place(b, row)});
    } else {
      others_.push_back(lower({c.a, c.b, c.c, c.d}, row));
    }
    values_[row++] = c.value;
  }
}

void Constraints::lower_bilinear_constraints(const Model& model) {
  int row = static_cast<int>(model.dot_constraints().size());
  for (const BilinearConstraint& c : model.bilinear_constraints()) {
    bilinears_.push_back({.dot = lower({c.a, c.b, c.c, c.d}, row), .B = c.B});
    values_[row++] = c.value;
  }
}

Constraints::Dot Constraints::lower(const std::array<int, 4>& points, int row) {
  std::array<int, 4> at;
  for (int i = 0; i < 4; ++i) at[i] = layout_.starts[points[i]];
  Dot dot{.row = row, .a = at[0], .b = at[1], .c = at[2], .d = at[3], .gradients = {}};
  for (int i = 0; i < 4; ++i) {  // Eq. (7): roles of one point are added up where it comes first
    const bool first = std::find(at.begin(), at.begin() + i, at[i]) == at.begin() + i;
    dot.gradients[i] = {.at = first ? gradient_place(at[i], row) : scrap_place(),
                        .w_cd = double(at[i] == at[0]) - double(at[i] == at[1]),
                        .w_ab = double(at[i] == at[2]) - double(at[i] == at[3])};
  }
  return dot;
}

uword Constraints::gradient_place(int start, int row) {
  if (start >= layout_.moving) return scrap_place();
  blocks_.push_back({.row = row, .start = start});
  return place(row) + uword(start);
}

void Constraints::lower_linear_constraints(const Model& model) {
  int row = quadratics_;
  for (const LinearConstraint& c : model.linear_constraints()) {
    const int first = static_cast<int>(terms_.size());
    for (const LinearConstraint::Term& term : c.terms) {
      terms_.push_back(term);
      jacobian_[place(row) + uword(term.coordinate)] = term.coefficient;  // Eq. (8), for good
    }
    linears_.push_back({.row = row, .first = first, .last = static_cast<int>(terms_.size())});
    values_[row++] = c.value;
  }
}

template <int dimension>
void Constraints::write_gradients(const Dot& c, const std::array<double, dimension>& u,
                                  const std::array<double, dimension>& w) {
  for (const Gradient& gradient : c.gradients) {
    for (int k = 0; k < dimension; ++k) {
      jacobian_[gradient.at + k] = gradient.w_cd * w[k] + gradient.w_ab * u[k];
    }
  }
}

template <int dimension, bool with_jacobian>
void Constraints::evaluate_dots(const double* x) {
  double* const phi = phi_.memptr();
  double* const jacobian = jacobian_.memptr();
  const double* const values = values_.memptr();
  for (const Distance& c : distances_) {  // Eq. (7)
    double square = 0.0;
    for (int k = 0; k < dimension; ++k) {
      const double ab = x[c.a + k] - x[c.b + k];
      square += ab * ab;
      if constexpr (with_jacobian) {
        jacobian[c.grad_a + k] = 2.0 * ab;
        jacobian[c.grad_b + k] = -2.0 * ab;
      }
    }
    phi[c.row] = square - values[c.row];
  }
  for (const Dot& c : others_) {  // Eq. (7)
    const auto u = difference<dimension>(x, c.a, c.b);
    const auto w = difference<dimension>(x, c.c, c.d);
    if constexpr (with_jacobian) write_gradients<dimension>(c, u, w);
    phi[c.row] = dot<dimension>(u, w) - values[c.row];
  }
}

template <int dimension, bool with_jacobian>
void Constraints::evaluate_bilinears(const double* x) {
  for (const Bilinear& c : bilinears_) {  // Eq. (7)
    const auto u = difference<dimension>(x, c.dot.a, c.dot.b);
    const auto Bw = product<dimension, false>(c.B, difference<dimension>(x, c.dot.c, c.dot.d));
    if constexpr (with_jacobian) {
      write_gradients<dimension>(c.dot, product<dimension, true>(c.B, u), Bw);
    }
    phi_[c.dot.row] = dot<dimension>(u, Bw) - values_[c.dot.row];
  }
}

template <bool with_jacobian>
void Constraints::evaluate_rows(const arma::vec& x) {
  if (layout_.dimension == 2) {
    evaluate_dots<2, with_jacobian>(x.memptr());
    evaluate_bilinears<2, with_jacobian>(x.memptr());
  } else {
    evaluate_dots<3, with_jacobian>(x.memptr());
    evaluate_bilinears<3, with_jacobian>(x.memptr());
  }
  for (const Linear& c : linears_) {  // Eq. (8)
    double sum = 0.0;
    for (int k = c.first; k < c.last; ++k) sum += terms_[k].coefficient * x[terms_[k].coordinate];
    phi_[c.row] = sum - values_[c.row];
  }
}

void Constraints::evaluate(const arma::vec& x) { evaluate_rows<true>(x); }

void Constraints::evaluate_phi(const arma::vec& x) { evaluate_rows<false>(x); }

template <int dimension>
void Constraints::multiply(const double* x, double* out) const {
  const double* const jacobian = jacobian_.memptr();
  for (const Block& block : blocks_) {
    const double* const entries = jacobian + place(block.row) + uword(block.start);
    double sum = 0.0;
    for (int k = 0; k < dimension; ++k) sum += entries[k] * x[block.start + k];
    out[block.row] += sum;
  }
}

void Constraints::multiply(const arma::vec& x, arma::vec& out) const {
  out.zeros();
  if (layout_.dimension == 2) {
    multiply<2>(x.memptr(), out.memptr());
  } else {
    multiply<3>(x.memptr(), out.memptr());
  }
  for (const Linear& c : linears_) {
    for (int k = c.first; k < c.last; ++k)
      out[c.row] += terms_[k].coefficient * x[terms_[k].coordinate];
  }
}

template <int dimension>
void Constraints::add_accelerations(const double* v, double* out) const {
  for (const Distance& c : distances_) {  // Eq. (7)
    const auto u = difference<dimension>(v, c.a, c.b);
    out[c.row] += 2.0 * dot<dimension>(u, u);
  }
  for (const Dot& c : others_) {
    out[c.row] += 2.0 * dot<dimension>(difference<dimension>(v, c.a, c.b),
                                       difference<dimension>(v, c.c, c.d));
  }
  for (const auto& [c, B] : bilinears_) {
    const auto Bw = product<dimension, false>(B, difference<dimension>(v, c.c, c.d));
    out[c.row] += 2.0 * dot<dimension>(difference<dimension>(v, c.a, c.b), Bw);
  }
}

void Constraints::add_accelerations(const arma::vec& v, arma::vec& out) const {
  if (layout_.dimension == 2) {
    add_accelerations<2>(v.memptr(), out.memptr());
  } else {
    add_accelerations<3>(v.memptr(), out.memptr());
  }
}

}  // namespace mbs::armadillo_dense
