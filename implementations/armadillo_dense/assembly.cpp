// Dense storage of the model, and Phi, Phi_q, residual and tangent computed over it.
#include "assembly.hpp"

#include <algorithm>

// Armadillo declares no dsymv. The trailing argument is the length of the character argument.
extern "C" void arma_fortran(dsymv)(const char* uplo, const arma::blas_int* n, const double* alpha,
                                    const double* A, const arma::blas_int* ldA, const double* x,
                                    const arma::blas_int* incx, const double* beta, double* y,
                                    const arma::blas_int* incy, arma::blas_len);

namespace mbs::armadillo_dense {

using arma::blas_int;
using arma::uword;

namespace {

constexpr double kOne = 1.0;
constexpr blas_int kStride = 1;

/// y += factor M x, with the lower triangle of M.
void add_symmetric_product(double factor, const arma::mat& M, const double* x, double* y) {
  const auto n = static_cast<blas_int>(M.n_rows);
  const blas_int ld = std::max(n, 1);
  arma_fortran(dsymv)("L", &n, &factor, M.memptr(), &ld, x, &kStride, &kOne, y, &kStride, 1);
}

/// y += factor A x, A: rows x columns. Costs nothing without columns.
void add_product(double factor, const double* A, blas_int rows, blas_int columns, const double* x,
                 double* y) {
  if (columns == 0) return;
  const blas_int ld = std::max(rows, 1);
  arma::blas::gemv("N", &rows, &columns, &factor, A, &ld, x, &kStride, &kOne, y, &kStride);
}

/// Lower triangle of C += factor A Aᵀ, A: rows x columns. Costs nothing without columns.
void add_outer_product(double factor, const double* A, blas_int rows, blas_int columns,
                       arma::mat& C) {
  if (columns == 0) return;
  const blas_int ld = std::max(rows, 1);
  arma::blas::syrk("L", "N", &rows, &columns, &factor, A, &ld, &kOne, C.memptr(), &ld);
}

/// sum_k x[a + k] - x[b + k] times the same of c and d.
template <int dimension>
double dot_of_differences(const double* x, int a, int b, int c, int d) {
  double sum = 0.0;
  for (int k = 0; k < dimension; ++k) sum += (x[a + k] - x[b + k]) * (x[c + k] - x[d + k]);
  return sum;
}

}  // namespace

Assembly::Assembly(const Model& model, const StepSettings& settings)
    : n_(model.variables()),
      m_(model.constraints()),
      dots_(static_cast<blas_int>(model.dot_constraints().size())),
      dimension_(model.dimension()),
      h_(settings.step * settings.step / 4.0),
      alpha_(settings.penalty),
      M_(n_, n_, arma::fill::zeros),
      scaled_Q_(n_),
      jacobian_(uword(n_) * uword(m_) + uword(dimension_), arma::fill::zeros),
      phi_(m_, arma::fill::zeros),
      gamma_(dots_, arma::fill::zeros) {
  for (const MassEntry& entry : model.mass()) M_(entry.row, entry.col) = entry.value;
  std::ranges::transform(model.force(), scaled_Q_.begin(), [this](double Q) { return h_ * Q; });
  lower_points(model);
  lower_dot_constraints(model);
  lower_linear_constraints(model);
  T0_ = M_;
  add_outer_product(h_ * alpha_, jacobian_.memptr() + uword(n_) * uword(dots_), n_, m_ - dots_,
                    T0_);
}

void Assembly::lower_points(const Model& model) {
  int next = n_;
  for (const Point& point : model.points()) {
    starts_.push_back(point.is_fixed() ? next : point.offset);
    if (point.is_fixed()) next += dimension_;
  }
  initial_positions_.zeros(next);
  for (std::size_t i = 0; i < starts_.size(); ++i) {
    std::copy_n(model.points()[i].position.begin(), dimension_,
                initial_positions_.begin() + starts_[i]);
  }
}

void Assembly::lower_dot_constraints(const Model& model) {
  int row = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) {
    if (constraint.a == constraint.c && constraint.b == constraint.d &&
        constraint.a != constraint.b) {
      const int a = starts_[constraint.a];
      const int b = starts_[constraint.b];
      distances_.push_back({.row = row,
                            .a = a,
                            .b = b,
                            .grad_a = gradient_place(a, row),
                            .grad_b = gradient_place(b, row),
                            .value = constraint.value});
    } else {
      others_.push_back(lower(constraint, row));
    }
    ++row;
  }
}

Assembly::Dot Assembly::lower(const DotConstraint& constraint, int row) const {
  const std::array<int, 4> at = {starts_[constraint.a], starts_[constraint.b],
                                 starts_[constraint.c], starts_[constraint.d]};
  Dot dot{.row = row,
          .a = at[0],
          .b = at[1],
          .c = at[2],
          .d = at[3],
          .gradients = {},
          .value = constraint.value};
  for (int i = 0; i < 4; ++i) {  // Eq. (7): roles of one point are added up where it comes first
    const bool first = std::find(at.begin(), at.begin() + i, at[i]) == at.begin() + i;
    dot.gradients[i] = {.at = first ? gradient_place(at[i], row) : scrap_place(),
                        .w_cd = double(at[i] == at[0]) - double(at[i] == at[1]),
                        .w_ab = double(at[i] == at[2]) - double(at[i] == at[3])};
  }
  return dot;
}

uword Assembly::gradient_place(int start, int row) const {
  const bool is_fixed = start >= n_;
  return is_fixed ? scrap_place() : uword(n_) * uword(row) + uword(start);
}

void Assembly::lower_linear_constraints(const Model& model) {
  int row = dots_;
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    const int first = static_cast<int>(terms_.size());
    for (const LinearConstraint::Term& term : constraint.terms) {
      terms_.push_back(term);
      jacobian_[gradient_place(term.coordinate, row)] = term.coefficient;  // Eq. (8), for good
    }
    linears_.push_back({.row = row,
                        .first = first,
                        .last = static_cast<int>(terms_.size()),
                        .value = constraint.value});
    ++row;
  }
}

template <int dimension>
void Assembly::evaluate_dots(const double* x) {
  double* const phi = phi_.memptr();
  double* const jacobian = jacobian_.memptr();
  for (const Distance& c : distances_) {  // Eq. (7)
    double square = 0.0;
    for (int k = 0; k < dimension; ++k) {
      const double ab = x[c.a + k] - x[c.b + k];
      square += ab * ab;
      jacobian[c.grad_a + k] = 2.0 * ab;
      jacobian[c.grad_b + k] = -2.0 * ab;
    }
    phi[c.row] = square - c.value;
  }
  for (const Dot& c : others_) {  // Eq. (7)
    for (const Dot::Gradient& gradient : c.gradients) {
      for (int k = 0; k < dimension; ++k) {
        jacobian[gradient.at + k] =
            gradient.w_cd * (x[c.c + k] - x[c.d + k]) + gradient.w_ab * (x[c.a + k] - x[c.b + k]);
      }
    }
    phi[c.row] = dot_of_differences<dimension>(x, c.a, c.b, c.c, c.d) - c.value;
  }
}

void Assembly::evaluate(const arma::vec& positions) {
  const double* const x = positions.memptr();
  if (dimension_ == 2) {
    evaluate_dots<2>(x);
  } else {
    evaluate_dots<3>(x);
  }
  for (const Linear& c : linears_) {  // Eq. (8)
    double sum = 0.0;
    for (int k = c.first; k < c.last; ++k) sum += terms_[k].coefficient * x[terms_[k].coordinate];
    phi_[c.row] = sum - c.value;
  }
}

void Assembly::negative_residual(const arma::vec& a, const arma::vec& mu, arma::vec& rhs) const {
  rhs = scaled_Q_;  // Eq. (3) with M a' in place of (4/Δt²) M q' + M â
  add_symmetric_product(-h_, M_, a.memptr(), rhs.memptr());
  add_product(-h_, jacobian_.memptr(), n_, m_, mu.memptr(), rhs.memptr());
}

void Assembly::tangent(arma::mat& T) const {
  T = T0_;  // Eq. (5)
  add_outer_product(h_ * alpha_, jacobian_.memptr(), n_, dots_, T);
}

void Assembly::velocity_projection(const arma::vec& v, arma::vec& rhs) const {
  rhs.zeros();  // Eq. (6)
  add_symmetric_product(1.0, M_, v.memptr(), rhs.memptr());
}

template <int dimension>
void Assembly::evaluate_dot_accelerations(const double* v) {
  for (const Distance& c : distances_) {  // Eq. (7)
    gamma_[c.row] = 2.0 * dot_of_differences<dimension>(v, c.a, c.b, c.a, c.b);
  }
  for (const Dot& c : others_) {
    gamma_[c.row] = 2.0 * dot_of_differences<dimension>(v, c.a, c.b, c.c, c.d);
  }
}

void Assembly::acceleration_projection(const arma::vec& velocities, const arma::vec& a,
                                       arma::vec& rhs) {
  if (dimension_ == 2) {
    evaluate_dot_accelerations<2>(velocities.memptr());
  } else {
    evaluate_dot_accelerations<3>(velocities.memptr());
  }
  rhs.zeros();  // Eq. (6)
  add_symmetric_product(1.0, M_, a.memptr(), rhs.memptr());
  add_product(-h_ * alpha_, jacobian_.memptr(), n_, dots_, gamma_.memptr(), rhs.memptr());
}

}  // namespace mbs::armadillo_dense
