// Constraints, Eqs. (7) and (8), and their tables made from the models.
#pragma once

#include <map>

#include "panels/vectors.hpp"
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

  /// phi = Φ(q), and the gradients for what follows.
  void evaluate(const S* q, S* phi) {
    evaluate_with(q, phi, [](int /*k*/, const S& /*phi*/) {});
  }
  /// The same, then λ += α Φ.
  void evaluate_and_update(const S* q, S* phi, const S& alpha, S* lambda) {
    evaluate_with(q, phi, [&](int k, const S& value) { lambda[k] += alpha * value; });
  }
  /// phi = Φ(q), and the gradients in these lanes; in the others they stay.
  void evaluate_where(const LaneMask& mask, const S* q, S* phi) {
    u_.swap(other_u_);
    vectors_.swap(other_vectors_);
    evaluate(q, phi);
    copy_where(~mask, other_u_, u_);
    copy_where(~mask, other_vectors_, vectors_);
  }
  /// then(k, Φ_k(q)); gradients stay what they are.
  template <typename Then>
  void values(const S* q, Then then) const;
  /// y += factor Φqᵀ t.
  void add_transposed(const S* t, const S& factor, S* y) const;
  /// y −= h Φqᵀ (λ + α φ).
  void add_forces(const S* lambda, const S* phi, const S& alpha, const S& h, S* y) const;
  /// t = Φq x, with the columns of fixed points; + 2 u̇·B ẇ if there is v, − given if not null.
  void product(const S* x, S* t, const S* v = nullptr, const S* given = nullptr) const {
    rates(x, v, given, [&](int k, const S& rate) { t[k] = rate; });
  }
  /// then(k, that t_k).
  template <typename Then>
  void rates(const S* x, const S* v, const S* given, Then then) const;
  /// y += f Φqᵀ t with that t, in one sweep.
  void add_projection(const S* x, const S* v, const S* given, const S& f, S* y) const;
  /// t = 2 u̇·B ẇ, which is Φ̇q v.
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
  void add_penalty(F* matrix, const S& s) const;
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
  /// Linear rows k …, with the columns that any of them has: of x_1 − x_3 and x_2 − x_3 columns 1,
  /// 2 and 3, values 1 0, 0 1 and −1 −1. Columns are filled up with zeros to a multiple of four.
  struct Strip {
    int row = 0, columns_end = 0;
  };
  static constexpr int kRows = std::min(4, kWidest<S>);  // of a strip
  struct RowPlace {
    Place a, b;
  };
  void add_pairs(std::span<const Model* const> models, const Rows& rows);
  void add_quads(std::span<const Model* const> models, const Rows& rows, const Program& program,
                 bool coupled);
  void add_linear(std::span<const Model* const> models, const Rows& rows);
  void make_strips();
  void find_rows(const Program& program);
  void multiply(const S* matrix, const S* x, S* y, bool transposed) const;
  template <typename Then>
  void evaluate_with(const S* q, S* phi, Then then);
  template <typename Factor>
  void add_gradients(Factor factor, S* y) const;
  [[nodiscard]] int first_linear() const { return count() - static_cast<int>(linear_.size()); }
  auto strip_sums(const S* x, int at, int end) const;
  template <typename W>
  void add_strip(const W& s, int at, int end, S* y) const;
  S loose_sum(int i, const S* x) const;
  void add_loose(int i, const S& s, S* y) const;
  template <typename Then>
  void linear_sums(const S* x, Then then) const;
  template <typename Factor>
  void add_linear_gradients(Factor factor, S* y) const;
  void add_linear_projection(const S* x, const S* given, const S& f, S* y) const;
  S half_pair_rate(int k, const S* x, const S* v) const;
  S quad_rate(int i, const S* x, const S* v) const;
  S quad_velocity_term(int i, const S* v) const;

  Pairs pairs_;
  std::vector<Quad> quads_;
  std::vector<int> matrix_of_quad_;  // -1: the identity
  std::vector<Place> places_;
  std::vector<Terms> linear_;
  std::vector<Strip> strips_;
  std::vector<int> strip_columns_;
  Array<S> strip_values_;   // kRows of each column
  std::vector<int> loose_;  // linear rows that no strip has
  std::vector<int> term_rows_;
  Array<S> term_coefficients_;
  Array<S> matrices_;  // B, D × D row by row
  std::vector<int> number_, multiplier_row_;
  Array<S> value_;
  Array<S> u_;                        // of each distance
  Array<S> vectors_;                  // A = B w, C = Bᵀ u, gradients of each other quadratic one
  Array<S> other_u_, other_vectors_;  // batches: where the next ones go
  Array<S> force_;                    // g h of Eq. (16)
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
    if (!all[i].is_distance()) continue;
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
  if (kLanesOf < S >> 1) other_u_ = u_;
}

template <typename S, int D>
void Constraints<S, D>::add_quads(std::span<const Model* const> models, const Rows& rows,
                                  const Program& program, bool coupled) {
  auto* places = coupled ? &places_ : nullptr;
  const auto& dots = models[0]->dot_constraints();
  const int dot_count = static_cast<int>(dots.size());
  for (int i = 0; i < dot_count; ++i) {
    const DotConstraint& c = dots[i];
    if (c.is_distance()) continue;
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
  if (kLanesOf < S >> 1) other_vectors_ = vectors_;
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
  make_strips();
}

template <typename S, int D>
void Constraints<S, D>::make_strips() {
  const int rows = static_cast<int>(linear_.size());
  for (int i = 0; i < rows;) {
    std::map<int, std::array<S, kRows>> columns;
    int terms = 0;
    for (int r = 0; r < kRows && i + r < rows; ++r) {
      for (int t = linear_[i + r].begin; t < linear_[i + r].end; ++t, ++terms) {
        const auto column = columns.try_emplace(term_rows_[t]).first;
        column->second[r] += term_coefficients_[t];
      }
    }
    const auto count_of = static_cast<int>(columns.size());
    if (kRows == 1 || i + kRows > rows || 3 * count_of > 2 * terms + 8) {
      loose_.push_back(i++);
      continue;
    }
    for (const auto& [column, values] : columns) {
      strip_columns_.push_back(column);
      strip_values_.insert(strip_values_.end(), values.begin(), values.end());
    }
    while (strip_columns_.size() % 4 != 0) {
      strip_columns_.push_back(columns.begin()->first);
      strip_values_.resize(strip_values_.size() + kRows, S(0.0));
    }
    strips_.push_back({count() - rows + i, static_cast<int>(strip_columns_.size())});
    i += kRows;
  }
}

/// Places of Φq in the saddle-point matrix: the multiplier's row in the columns of its points, or
/// its column in the rows of those that it comes before (Pattern::solved).
template <typename S, int D>
void Constraints<S, D>::find_rows(const Program& program) {
  int k = 0;
  const auto place_at = [&](int point) {
    return point < row(k) ? place_of(program, row(k), point)
                          : Place{program.entry(point, row(k)), 1};
  };
  for (int i = 0; i < pairs_.count(); ++i, ++k) {
    RowPlace place;
    if (i < pairs_.one) place.a = place_at(pairs_.list[i].a);
    if (i < pairs_.two) place.b = place_at(pairs_.list[i].b);
    pair_rows_.push_back(place);
  }
  for (const Quad& quad : quads_) {
    for (int i = 0; i < 4; ++i) {
      quad_rows_.push_back(i < quad.free ? place_at(quad.points[i].row) : Place{});
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

}  // namespace mbs::compiled_ldl

#include "elements/constraint_matrix.hpp"
#include "elements/constraint_products.hpp"
