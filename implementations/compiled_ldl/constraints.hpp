// Constraints, Eqs. (7) and (8): values, Jacobian products, what they add to the matrix.
#pragma once

#include "scene.hpp"

namespace mbs::compiled_ldl {

/// In the order of the program: distances, other quadratic ones, linear ones.
template <typename S, int D>
class Constraints {
 public:
  Constraints(std::span<const Model* const> models, const Program& program, const Rows& rows,
              bool multipliers, bool second_derivatives);

  [[nodiscard]] int count() const { return static_cast<int>(value_.size()); }
  /// Number in the model of constraint k here.
  [[nodiscard]] int number(int k) const { return number_[k]; }
  /// Row of its multiplier, in the saddle-point forms.
  [[nodiscard]] int row(int k) const { return multiplier_row_[k]; }
  S& value(int k) { return value_[k]; }

  /// phi = Φ(q), and the gradients for what follows; those of the evaluation before become
  /// `earlier` ones, which stay if `exchange` is false.
  void evaluate(const S* q, S* phi, bool exchange = true) {
    evaluate_with(q, phi, exchange, [](int /*k*/, const S& /*phi*/) {});
  }
  /// The same, then λ += α Φ.
  void evaluate_and_update(const S* q, S* phi, const S& alpha, S* lambda) {
    evaluate_with(q, phi, true, [&](int k, const S& value) { lambda[k] += alpha * value; });
  }
  /// then(k, Φ_k(q)); gradients stay what they are.
  template <typename Then>
  void values(const S* q, Then then) const;
  /// Gradients become `earlier` ones in these lanes.
  void keep_where(const LaneMask& mask) {
    copy_where(mask, u_, earlier_u_);
    copy_where(mask, vectors_, earlier_vectors_);
  }
  /// y += Φqᵀ t.
  void add_transposed(const S* t, S* y) const;
  /// y −= h Φqᵀ (λ + α φ).
  void add_forces(const S* lambda, const S* phi, const S& alpha, const S& h, S* y) const;
  /// y −= f (Φqᵀ Φq x + Φqᵀ t) with t = Φ̇q v if there is v, the first two Φq the earlier ones (in
  /// single precision the present ones); x is zero at fixed points.
  void add_projection(const S* x, const S* v, const S& f, S* y) const;
  /// Whether one of these rows is among those of constraint k's points.
  [[nodiscard]] bool touches(int k, const std::vector<int>& point_rows) const;
  /// Φq x of constraint k alone, with the columns of fixed points.
  S product_of(int k, const S* x) const;
  /// y += t times the gradient of constraint k.
  void add_gradient(int k, const S& t, S* y) const;
  /// t = Φq x, with the columns of fixed points.
  void product(const S* x, S* t, bool earlier = false) const;
  /// t = 2 u̇·B ẇ, which is Φ̇q v + Φ̇t but for what drivers prescribe.
  void velocity_terms(const S* v, S* t) const;

  /// What never changes: linear rows. `s` = (Δt²/4) α of the penalty form.
  template <typename F>
  void add_constant(F* matrix, const S& s) const;
  template <typename F>
  void add_penalty(F* matrix, const S& s, bool earlier = false) const;
  template <typename F>
  void add_rows(F* matrix) const;

  /// Eq. (16): keeps g h for add_curvature() and y += Σ g h ∇²Φ x.
  void keep_forces(const S* g, const S& h);
  template <typename F>
  void add_curvature(F* matrix) const;
  void add_curvature_product(const S* x, S* y) const;

 private:
  static constexpr int kQuad = 6 * D;  // A, C and four gradients
  struct Terms {
    int begin = 0, end = 0;
  };
  struct RowPlace {
    Place a, b;
  };
  void add_pairs(std::span<const Model* const> models, const Rows& rows);
  void add_quads(std::span<const Model* const> models, const Rows& rows, const Program& program,
                 bool coupled);
  void add_linear(std::span<const Model* const> models, const Rows& rows);
  void find_rows(const Program& program);
  void multiply(const S* matrix, const S* x, S* y, bool transposed) const;
  template <typename Then>
  void evaluate_with(const S* q, S* phi, bool exchange, Then then);
  template <typename Factor>
  void add_gradients(Factor factor, S* y) const;
  S quad_velocity_term(int i, const S* v) const;

  Pairs pairs_;
  std::vector<Quad> quads_;
  std::vector<int> matrix_of_quad_;  // -1: the identity
  std::vector<Place> places_;
  std::vector<Terms> linear_;
  std::vector<int> term_rows_;
  Array<S> term_coefficients_;
  Array<S> matrices_;  // B, D × D row by row
  std::vector<int> number_, multiplier_row_;
  Array<S> value_;
  Array<S> u_, earlier_u_;              // of each distance
  Array<S> vectors_, earlier_vectors_;  // A = B w, C = Bᵀ u, gradients of each other quadratic one
  Array<S> force_;                      // g h of Eq. (16)
  std::vector<RowPlace> pair_rows_;
  std::vector<Place> quad_rows_;    // four of each
  std::vector<Place> term_places_;  // saddle-point forms: of each term
  struct Product {
    int at, one, other;  // storage, two terms
  };
  std::vector<Product> products_;  // penalty form: of linear rows
};

}  // namespace mbs::compiled_ldl

#include "constraints_evaluate.hpp"
#include "constraints_matrix.hpp"
#include "constraints_projection.hpp"
#include "constraints_setup.hpp"
#include "constraints_single.hpp"
#include "constraints_values.hpp"
