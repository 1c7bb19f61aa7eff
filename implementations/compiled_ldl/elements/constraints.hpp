// Constraints, Eqs. (7) and (8): values, Jacobian products, what they add to the matrix.
#pragma once

#include <type_traits>

#include "scene.hpp"

namespace mbs::compiled_ldl {

/// In the order of the program: distances, other quadratic ones, linear ones. Of a distance u is
/// kept, its row of Φq is 2u at a, −2u at b: u = (3, 4) with value 24 has φ = 1 and the row (6 8 −6
/// −8). Of a dot product or u·B w, kQuad numbers are kept, A = B w, C = Bᵀ u and the gradients of
/// up to four points: u·w with u = (1, 2) from b to a and w = (3, 4) from a to c, A = (3, 4) and C
/// = (1, 2), has at c C = (1, 2), at a A − C = (2, 2), at b −A = (−3, −4).
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

  /// Of rows of Φq as Σ n_i e_i (Changing): e_i of constraint k has (i, row, entry), to
  /// all of which `then` is applied.
  template <typename Then>
  void unit_entries(int k, Then then) const;
  /// then(k, i, n_i).
  template <typename Then>
  void gradient_numbers(Then then) const;

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
  std::vector<Place> quad_rows_;  // four of each
  std::vector<int> term_places_;  // saddle-point forms: of each term
  struct Product {
    int at, one, other;  // storage, two terms
  };
  std::vector<Product> products_;  // penalty form: of linear rows
};

// Tables made from the models.

template <typename S, int D>
Constraints<S, D>::Constraints(std::span<const Model* const> models, const Program& program,
                               const Rows& rows, bool multipliers, bool second_derivatives) {
  const bool coupled = !multipliers || second_derivatives;
  add_pairs(models, rows);
  if (coupled) place_pairs(pairs_, program);
  add_quads(models, rows, program, coupled);
  add_linear(models, rows);
  force_.resize(number_.size(), S(0.0));
  const int points = static_cast<int>(program.row_of_node.size()) - count();
  if (multipliers) {
    for (const int k : number_) multiplier_row_.push_back(program.row_of_node[points + k]);
    if (program.constant_fronts == 0) find_rows(program);
    return;
  }
  for (const Terms& terms : linear_) {
    for (int i = terms.begin; i < terms.end; ++i) {
      for (int j = terms.begin; j < terms.end; ++j) {
        if (term_rows_[i] < term_rows_[j]) continue;
        products_.push_back({program.entry(term_rows_[i], term_rows_[j]), i, j});
      }
    }
  }
}

template <typename S, int D>
void Constraints<S, D>::add_pairs(std::span<const Model* const> models, const Rows& rows) {
  const auto& all = models[0]->dot_constraints();
  std::vector<std::array<int, 2>> points;
  std::vector<int> numbers, order;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    if (!is_distance(all[i])) continue;
    points.push_back({all[i].a, all[i].b});
    numbers.push_back(i);
  }
  pairs_ = make_pairs(points, rows, order);
  for (const int k : order) {
    const int number = numbers[k];
    number_.push_back(number);
    value_.push_back(
        of_models<S>(models, [&](const Model& m) { return m.dot_constraints()[number].value; }));
  }
  u_.resize(points.size() * D, S(0.0));
  earlier_u_ = u_;
}

template <typename S, int D>
void Constraints<S, D>::add_quads(std::span<const Model* const> models, const Rows& rows,
                                  const Program& program, bool coupled) {
  auto* places = coupled ? &places_ : nullptr;
  const auto& dots = models[0]->dot_constraints();
  const int dot_count = static_cast<int>(dots.size());
  for (int i = 0; i < dot_count; ++i) {
    const DotConstraint& c = dots[i];
    if (is_distance(c)) continue;
    quads_.push_back(make_quad({c.a, c.b, c.c, c.d}, rows, program, places));
    matrix_of_quad_.push_back(-1);
    number_.push_back(i);
    value_.push_back(
        of_models<S>(models, [&](const Model& m) { return m.dot_constraints()[i].value; }));
  }
  const auto& bilinear = models[0]->bilinear_constraints();
  for (int i = 0; i < static_cast<int>(bilinear.size()); ++i) {
    const BilinearConstraint& c = bilinear[i];
    quads_.push_back(make_quad({c.a, c.b, c.c, c.d}, rows, program, places));
    matrix_of_quad_.push_back(static_cast<int>(matrices_.size()));
    number_.push_back(dot_count + i);
    value_.push_back(
        of_models<S>(models, [&](const Model& m) { return m.bilinear_constraints()[i].value; }));
    for (int x = 0; x < D; ++x) {
      for (int y = 0; y < D; ++y) {
        matrices_.push_back(of_models<S>(
            models, [&](const Model& m) { return m.bilinear_constraints()[i].B[x][y]; }));
      }
    }
  }
  vectors_.resize(quads_.size() * kQuad, S(0.0));
  earlier_vectors_ = vectors_;
}

template <typename S, int D>
void Constraints<S, D>::add_linear(std::span<const Model* const> models, const Rows& rows) {
  const auto& all = models[0]->linear_constraints();
  const int before = models[0]->constraints() - static_cast<int>(all.size());
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    Terms terms;
    terms.begin = static_cast<int>(term_rows_.size());
    for (int t = 0; t < static_cast<int>(all[i].terms.size()); ++t) {
      term_rows_.push_back(rows.of_coordinate[all[i].terms[t].coordinate]);
      term_coefficients_.push_back(of_models<S>(
          models, [&](const Model& m) { return m.linear_constraints()[i].terms[t].coefficient; }));
    }
    terms.end = static_cast<int>(term_rows_.size());
    linear_.push_back(terms);
    number_.push_back(before + i);
    value_.push_back(
        of_models<S>(models, [&](const Model& m) { return m.linear_constraints()[i].value; }));
  }
}

/// Places of Φq in the saddle-point matrix: the multiplier's row in the columns of its points. Only
/// linear rows may come before some of these (Pattern::solved).
template <typename S, int D>
void Constraints<S, D>::find_rows(const Program& program) {
  int k = 0;
  for (int i = 0; i < pairs_.count(); ++i, ++k) {
    RowPlace place;
    if (i < pairs_.one) place.a = place_of(program, row(k), pairs_.list[i].a);
    if (i < pairs_.two) place.b = place_of(program, row(k), pairs_.list[i].b);
    pair_rows_.push_back(place);
  }
  for (const Quad& quad : quads_) {
    for (int i = 0; i < 4; ++i) {
      quad_rows_.push_back(i < quad.free ? place_of(program, row(k), quad.points[i].row) : Place{});
    }
    ++k;
  }
  for (const Terms& terms : linear_) {
    for (int i = terms.begin; i < terms.end; ++i) {
      const auto [column, below] = std::minmax({row(k), term_rows_[i]});
      term_places_.push_back(program.entry(below, column));
    }
    ++k;
  }
}

// Values and products with the Jacobian.

/// y = B x, or Bᵀ x.
template <typename S, int D>
void Constraints<S, D>::multiply(const S* matrix, const S* x, S* y, bool transposed) const {
  for (int i = 0; i < D; ++i) {
    S sum = S(0.0);
    for (int j = 0; j < D; ++j) sum += matrix[transposed ? j * D + i : i * D + j] * x[j];
    y[i] = sum;
  }
}

template <typename S, int D>
template <typename Then>
void Constraints<S, D>::evaluate_with(const S* q, S* phi, bool exchange, Then then) {
  if (exchange) {
    u_.swap(earlier_u_);
    vectors_.swap(earlier_vectors_);
  }
  int k = 0;
  S* u = u_.data();
  for (const Pair& pair : pairs_.list) {
    for (int x = 0; x < D; ++x) u[x] = q[pair.a + x] - q[pair.b + x];
    phi[k] = dot<D>(u, u) - value_[k];
    then(k, phi[k]);
    u += D;
    ++k;
  }
  S* vectors = vectors_.data();
  for (std::size_t i = 0; i < quads_.size(); ++i, ++k, vectors += kQuad) {
    const Quad& quad = quads_[i];
    S* a = vectors;
    S* c = vectors + D;
    for (int x = 0; x < D; ++x) c[x] = q[quad.a + x] - q[quad.b + x];
    for (int x = 0; x < D; ++x) a[x] = q[quad.c + x] - q[quad.d + x];
    if (matrix_of_quad_[i] >= 0) {
      const S* matrix = matrices_.data() + matrix_of_quad_[i];
      S u_copy[D], w[D];
      for (int x = 0; x < D; ++x) u_copy[x] = c[x];
      for (int x = 0; x < D; ++x) w[x] = a[x];
      multiply(matrix, w, a, false);
      phi[k] = dot<D>(u_copy, a) - value_[k];
      multiply(matrix, u_copy, c, true);
    } else {
      phi[k] = dot<D>(c, a) - value_[k];
    }
    then(k, phi[k]);
    find_gradients<D>(quad, a, c, vectors + 2 * D);
  }
  for (const Terms& terms : linear_) {
    S sum = S(0.0);
    for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * q[term_rows_[i]];
    phi[k] = sum - value_[k];
    then(k, phi[k]);
    ++k;
  }
}

/// y += Σ factor(k) times the gradient of constraint k, at free points.
template <typename S, int D>
template <typename Factor>
void Constraints<S, D>::add_gradients(Factor factor, S* y) const {
  int k = 0;
  const S* u = u_.data();
  for (; k < pairs_.two; ++k, u += D) {
    const Pair& pair = pairs_.list[k];
    const S s = factor(k) * S(2.0);
    for (int x = 0; x < D; ++x) {
      const S force = s * u[x];
      y[pair.a + x] += force;
      y[pair.b + x] -= force;
    }
  }
  for (; k < pairs_.one; ++k, u += D) {
    const Pair& pair = pairs_.list[k];
    const S s = factor(k) * S(2.0);
    for (int x = 0; x < D; ++x) y[pair.a + x] += s * u[x];
  }
  k = pairs_.count();
  const S* g = quads_.empty() ? nullptr : vectors_.data() + 2 * D;
  for (const Quad& quad : quads_) {
    const S s = factor(k++);
    for (int i = 0; i < quad.free; ++i) {
      for (int x = 0; x < D; ++x) y[quad.points[i].row + x] += s * g[i * D + x];
    }
    g += kQuad;
  }
  for (const Terms& terms : linear_) {
    const S s = factor(k++);
    for (int i = terms.begin; i < terms.end; ++i) y[term_rows_[i]] += s * term_coefficients_[i];
  }
}

template <typename S, int D>
void Constraints<S, D>::add_transposed(const S* t, S* y) const {
  add_gradients([t](int k) { return t[k]; }, y);
}

template <typename S, int D>
void Constraints<S, D>::add_forces(const S* lambda, const S* phi, const S& alpha, const S& h,
                                   S* y) const {
  add_gradients([&](int k) { return -h * (lambda[k] + alpha * phi[k]); }, y);
}

template <typename S, int D>
void Constraints<S, D>::product(const S* x, S* t, bool earlier) const {
  int k = 0;
  const S* u = (earlier ? earlier_u_ : u_).data();
  for (const Pair& pair : pairs_.list) {
    S sum = S(0.0);
    for (int i = 0; i < D; ++i) sum += u[i] * (x[pair.a + i] - x[pair.b + i]);
    t[k++] = sum * S(2.0);
    u += D;
  }
  const S* vectors = (earlier ? earlier_vectors_ : vectors_).data();
  for (const Quad& quad : quads_) {
    S sum = S(0.0);
    for (int i = 0; i < D; ++i) {
      sum += vectors[i] * (x[quad.a + i] - x[quad.b + i]) +
             vectors[D + i] * (x[quad.c + i] - x[quad.d + i]);
    }
    t[k++] = sum;
    vectors += kQuad;
  }
  for (const Terms& terms : linear_) {
    S sum = S(0.0);
    for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * x[term_rows_[i]];
    t[k++] = sum;
  }
}

template <typename S, int D>
void Constraints<S, D>::velocity_terms(const S* v, S* t) const {
  int k = 0;
  for (const Pair& pair : pairs_.list) {
    S rate[D];
    for (int x = 0; x < D; ++x) rate[x] = v[pair.a + x] - v[pair.b + x];
    t[k++] = S(2.0) * dot<D>(rate, rate);
  }
  for (int i = 0; i < static_cast<int>(quads_.size()); ++i) t[k++] = quad_velocity_term(i, v);
  while (k < count()) t[k++] = S(0.0);
}

template <typename S, int D>
S Constraints<S, D>::quad_velocity_term(int i, const S* v) const {
  const Quad& quad = quads_[i];
  S u[D], w[D], turned[D];
  for (int x = 0; x < D; ++x) u[x] = v[quad.a + x] - v[quad.b + x];
  for (int x = 0; x < D; ++x) w[x] = v[quad.c + x] - v[quad.d + x];
  if (matrix_of_quad_[i] < 0) return S(2.0) * dot<D>(u, w);
  multiply(matrices_.data() + matrix_of_quad_[i], w, turned, false);
  return S(2.0) * dot<D>(u, turned);
}

template <typename S, int D>
template <typename Then>
void Constraints<S, D>::values(const S* q, Then then) const {
  int k = 0;
  for (const Pair& pair : pairs_.list) {
    S u[D];
    for (int x = 0; x < D; ++x) u[x] = q[pair.a + x] - q[pair.b + x];
    then(k, dot<D>(u, u) - value_[k]);
    ++k;
  }
  for (std::size_t i = 0; i < quads_.size(); ++i, ++k) {
    const Quad& quad = quads_[i];
    S u[D], w[D], turned[D];
    for (int x = 0; x < D; ++x) u[x] = q[quad.a + x] - q[quad.b + x];
    for (int x = 0; x < D; ++x) w[x] = q[quad.c + x] - q[quad.d + x];
    const int matrix = matrix_of_quad_[i];
    if (matrix >= 0) multiply(matrices_.data() + matrix, w, turned, false);
    then(k, dot<D>(u, matrix >= 0 ? turned : w) - value_[k]);
  }
  for (const Terms& terms : linear_) {
    S sum = S(0.0);
    for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * q[term_rows_[i]];
    then(k, sum - value_[k]);
    ++k;
  }
}

/// A distance has the numbers u, another quadratic one A and C, a linear one 1.
template <typename S, int D>
template <typename Then>
void Constraints<S, D>::unit_entries(int k, Then then) const {
  if (k < pairs_.count()) {
    const Pair& pair = pairs_.list[k];
    for (int x = 0; x < D && k < pairs_.one; ++x) {
      then(x, pair.a + x, S(2.0));
      if (k < pairs_.two) then(x, pair.b + x, S(-2.0));
    }
    return;
  }
  const int at = k - pairs_.count();
  if (at < static_cast<int>(quads_.size())) {
    for (int i = 0; i < quads_[at].free; ++i) {
      const Quad::Point& point = quads_[at].points[i];
      for (int x = 0; x < D; ++x) {
        then(x, point.row + x, S(point.sign_a));
        then(D + x, point.row + x, S(point.sign_c));
      }
    }
    return;
  }
  const Terms& terms = linear_[at - quads_.size()];
  for (int i = terms.begin; i < terms.end; ++i) then(0, term_rows_[i], term_coefficients_[i]);
}

template <typename S, int D>
template <typename Then>
void Constraints<S, D>::gradient_numbers(Then then) const {
  int k = 0;
  for (; k < pairs_.count(); ++k) {
    for (int x = 0; x < D; ++x) then(k, x, u_[k * D + x]);
  }
  for (std::size_t i = 0; i < quads_.size(); ++i, ++k) {
    for (int x = 0; x < 2 * D; ++x) then(k, x, vectors_[i * kQuad + x]);
  }
  for (; k < count(); ++k) then(k, 0, S(1.0));
}

// What they add to the matrix of Eqs. (5), (12) and (14).

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
void Constraints<S, D>::add_penalty(F* matrix, const S& s, bool earlier) const {
  const S s4 = s * S(4.0);  // two factors 2 of Φq
  const S* u = (earlier ? earlier_u_ : u_).data();
  int k = 0;
  for (; k < pairs_.two; ++k, u += D) add_pair<D>(matrix, pairs_.list[k], 2, s4, u);
  for (; k < pairs_.one; ++k, u += D) add_pair<D>(matrix, pairs_.list[k], 1, s4, u);
  const S* vectors = (earlier ? earlier_vectors_ : vectors_).data();
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

// Right-hand sides of the projections in one sweep.

template <typename S, int D>
void Constraints<S, D>::add_projection(const S* x, const S* v, const S& f, S* y) const {
  constexpr bool kPresent = std::is_same_v<S, float>;
  const S* u = u_.data();
  const S* e = (kPresent ? u_ : earlier_u_).data();
  for (int k = 0; k < pairs_.one; ++k, u += D, e += D) {
    const Pair& pair = pairs_.list[k];
    S sum = S(0.0), square = S(0.0), force[D];
    for (int i = 0; i < D; ++i) sum += e[i] * (x[pair.a + i] - x[pair.b + i]);
    sum *= S(4.0) * f;
    for (int i = 0; i < D; ++i) force[i] = sum * e[i];
    if (v != nullptr) {
      for (int i = 0; i < D; ++i) {
        const S rate = v[pair.a + i] - v[pair.b + i];
        square += rate * rate;
      }
      square *= S(4.0) * f;
      for (int i = 0; i < D; ++i) force[i] += square * u[i];
    }
    for (int i = 0; i < D; ++i) y[pair.a + i] -= force[i];
    if (k >= pairs_.two) continue;
    for (int i = 0; i < D; ++i) y[pair.b + i] += force[i];
  }
  const int behind =
      quads_.empty() ? 0 : 2 * D;  // where there are none, there are no vectors either
  const S* g = vectors_.data() + behind;
  const S* earlier = (kPresent ? vectors_ : earlier_vectors_).data() + behind;
  for (int k = 0; k < static_cast<int>(quads_.size()); ++k, g += kQuad, earlier += kQuad) {
    const Quad& quad = quads_[k];
    S sum = S(0.0);
    for (int i = 0; i < quad.free; ++i) sum += dot<D>(earlier + i * D, x + quad.points[i].row);
    sum *= f;
    const S term = v == nullptr ? S(0.0) : f * quad_velocity_term(k, v);
    for (int i = 0; i < quad.free; ++i) {
      S* to = y + quad.points[i].row;
      for (int j = 0; j < D; ++j) to[j] -= sum * earlier[i * D + j] + term * g[i * D + j];
    }
  }
  for (const Terms& terms : linear_) {
    S sum = S(0.0);
    for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * x[term_rows_[i]];
    sum *= f;
    for (int i = terms.begin; i < terms.end; ++i) y[term_rows_[i]] -= sum * term_coefficients_[i];
  }
}

// One constraint alone, for those that drivers touch.

template <typename S, int D>
bool Constraints<S, D>::touches(int k, const std::vector<int>& point_rows) const {
  const auto is_one = [&](int row) {
    return std::find(point_rows.begin(), point_rows.end(), row) != point_rows.end();
  };
  if (k < pairs_.count()) return is_one(pairs_.list[k].a) || is_one(pairs_.list[k].b);
  const int i = k - pairs_.count();
  if (i >= static_cast<int>(quads_.size())) return false;
  const Quad& quad = quads_[i];
  return is_one(quad.a) || is_one(quad.b) || is_one(quad.c) || is_one(quad.d);
}

template <typename S, int D>
S Constraints<S, D>::product_of(int k, const S* x) const {
  S sum = S(0.0);
  if (k < pairs_.count()) {
    const Pair& pair = pairs_.list[k];
    for (int i = 0; i < D; ++i) sum += u_[k * D + i] * (x[pair.a + i] - x[pair.b + i]);
    return S(2.0) * sum;
  }
  const int at = k - pairs_.count();
  if (at < static_cast<int>(quads_.size())) {
    const Quad& quad = quads_[at];
    const S* a = vectors_.data() + at * kQuad;
    for (int i = 0; i < D; ++i) {
      sum += a[i] * (x[quad.a + i] - x[quad.b + i]) + a[D + i] * (x[quad.c + i] - x[quad.d + i]);
    }
    return sum;
  }
  const Terms& terms = linear_[at - quads_.size()];
  for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * x[term_rows_[i]];
  return sum;
}

template <typename S, int D>
void Constraints<S, D>::add_gradient(int k, const S& t, S* y) const {
  if (k < pairs_.count()) {
    const Pair& pair = pairs_.list[k];
    for (int i = 0; i < D; ++i) {
      const S force = S(2.0) * t * u_[k * D + i];
      y[pair.a + i] += force;
      y[pair.b + i] -= force;
    }
    return;
  }
  const int at = k - pairs_.count();
  if (at < static_cast<int>(quads_.size())) {
    const S* g = vectors_.data() + at * kQuad + 2 * D;
    for (int i = 0; i < quads_[at].free; ++i) {
      for (int x = 0; x < D; ++x) y[quads_[at].points[i].row + x] += t * g[i * D + x];
    }
    return;
  }
  const Terms& terms = linear_[at - quads_.size()];
  for (int i = terms.begin; i < terms.end; ++i) y[term_rows_[i]] += t * term_coefficients_[i];
}

}  // namespace mbs::compiled_ldl
