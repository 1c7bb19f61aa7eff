// Dense matrices of the model: M, T and the right-hand sides, computed over Phi_q and the forces.
#include "assembly.hpp"

#include <algorithm>
#include <string>

// Armadillo declares no dsymv. The trailing argument is the length of the character argument.
extern "C" void arma_fortran(dsymv)(const char* uplo, const arma::blas_int* n, const double* alpha,
                                    const double* A, const arma::blas_int* ldA, const double* x,
                                    const arma::blas_int* incx, const double* beta, double* y,
                                    const arma::blas_int* incy, arma::blas_len);

namespace mbs::armadillo_dense {

using arma::blas_int;

namespace {

constexpr double kOne = 1.0;
constexpr blas_int kStride = 1;
constexpr double kLargestMatrix = 2.0 * 1024.0 * 1024.0 * 1024.0;  // bytes

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

}  // namespace

void require_storable(const Model& model) {
  const double n = model.variables();
  if (8.0 * n * std::max(n, double(model.constraints())) > kLargestMatrix) {
    throw Unsupported("a dense matrix for " + std::to_string(model.variables()) +
                      " variables and " + std::to_string(model.constraints()) +
                      " constraints would take more than 2 GiB");
  }
}

Assembly::Assembly(const Model& model, const StepSettings& settings)
    : layout_(model),
      n_(model.variables()),
      m_(model.constraints()),
      h_(settings.step * settings.step / 4.0),
      alpha_(settings.penalty),
      constraints_(model, layout_),
      drivers_(model, layout_),
      forces_(model, layout_, settings),
      M_(n_, n_, arma::fill::zeros),
      scaled_Q_(n_),
      time_terms_(drivers_.drive_linear() ? m_ : constraints_.quadratics(), arma::fill::zeros) {
  for (const MassEntry& entry : model.mass()) M_(entry.row, entry.col) = entry.value;
  std::ranges::transform(model.force(), scaled_Q_.begin(), [this](double Q) { return h_ * Q; });
  if (!model.linear_constraints().empty()) add_linear_constraints(model);
}

void Assembly::add_linear_constraints(const Model& model) {
  T0_ = M_;
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const LinearConstraint::Term& right : constraint.terms) {
      for (const LinearConstraint::Term& left : constraint.terms) {
        if (left.coordinate < right.coordinate) continue;
        T0_(left.coordinate, right.coordinate) +=
            h_ * alpha_ * left.coefficient * right.coefficient;
      }
    }
  }
}

void Assembly::drive(double t, arma::vec& x, arma::vec& v) {
  drivers_.sample(t, x, v, constraints_.values());
  drivers_.load(h_, scaled_Q_);
}

void Assembly::negative_residual(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                                 const arma::vec& mu, arma::vec& rhs) {
  rhs = scaled_Q_;  // Eq. (3) with M a' in place of (4/Δt²) M q' + M â
  if (!forces_.empty()) forces_.evaluate(x, v, rhs);
  add_symmetric_product(-h_, M_, a.memptr(), rhs.memptr());
  add_product(-h_, constraints_.jacobian(), n_, m_, mu.memptr(), rhs.memptr());
}

void Assembly::tangent(arma::mat& T) const {
  T = T0_.is_empty() ? M_ : T0_;  // Eq. (5)
  add_outer_product(h_ * alpha_, constraints_.jacobian(), n_, constraints_.quadratics(), T);
  if (forces_.stiffen()) forces_.add_to(T);
}

void Assembly::velocity_projection(const arma::vec& x, const arma::vec& v, arma::vec& rhs) {
  mass_product(v, rhs);  // Eq. (6)
  if (drivers_.empty()) return;
  drivers_.evaluate_rates(x, time_terms_);
  subtract_time_terms(rhs);
}

void Assembly::acceleration_projection(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                                       arma::vec& rhs) {
  mass_product(a, rhs);  // Eq. (6)
  constraints_.evaluate_accelerations(v, time_terms_);
  if (!drivers_.empty()) {
    std::fill(time_terms_.begin() + constraints_.quadratics(), time_terms_.end(), 0.0);
    drivers_.add_accelerations(x, time_terms_);
  }
  subtract_time_terms(rhs);
}

void Assembly::mass_product(const arma::vec& x, arma::vec& rhs) const {
  rhs.zeros();
  add_symmetric_product(1.0, M_, x.memptr(), rhs.memptr());
  if (forces_.stiffen()) forces_.add_product(x, rhs);
}

void Assembly::subtract_time_terms(arma::vec& rhs) const {
  const auto rows = static_cast<blas_int>(time_terms_.n_elem);
  add_product(-h_ * alpha_, constraints_.jacobian(), n_, rows, time_terms_.memptr(), rhs.memptr());
}

}  // namespace mbs::armadillo_dense
