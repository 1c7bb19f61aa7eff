// Constraints<S, D>: tables made from the models. Part of constraints.hpp.
#pragma once

#include "constraints.hpp"

namespace mbs::compiled_ldl {

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
    find_rows(program);
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
    if (all[i].a != all[i].c || all[i].b != all[i].d) continue;
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
    if (c.a == c.c && c.b == c.d) continue;
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

/// Places of Φq in the saddle-point matrix: the multiplier's row in the columns of its points.
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
      term_places_.push_back(place_of(program, row(k), term_rows_[i]));
    }
    ++k;
  }
}

}  // namespace mbs::compiled_ldl
