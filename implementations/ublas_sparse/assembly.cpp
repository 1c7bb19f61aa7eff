// Lowers the constraints of a Model to flat arrays and evaluates them.
#include "assembly.hpp"

#include <utility>

namespace mbs::ublas_sparse {

Constraints::Constraints(const Model& model, const Points& points)
    : bilinears_(model, points, static_cast<int>(model.dot_constraints().size())) {
  add_dots(model, points);
  for (const BilinearConstraint& bilinear : model.bilinear_constraints()) {
    values_.push_back(bilinear.value);
  }
  for (const LinearConstraint& linear : model.linear_constraints()) {
    linears_.push_back({static_cast<int>(values_.size()), linear.terms});
    values_.push_back(linear.value);
  }
}

void Constraints::add_dots(const Model& model, const Points& points) {
  for (const DotConstraint& dot : model.dot_constraints()) {
    const int row = static_cast<int>(values_.size());
    values_.push_back(dot.value);
    if (dot.a == dot.c && dot.b == dot.d && dot.a != dot.b) {
      distances_.push_back({row, points.first(dot.a), points.first(dot.b)});
    } else {
      dots_.push_back({row, points.first(dot.a), points.first(dot.b), points.first(dot.c),
                       points.first(dot.d)});
      append_columns(points, dots_.back(), dot_columns_);
    }
  }
}

SparseMatrix Constraints::jacobian_storage(const Points& points) const {
  std::vector<Entry> entries;
  for (const Distance& distance : distances_) {
    for (int point : {distance.a, distance.b}) {
      if (!points.is_free(point)) continue;
      for (int k = 0; k < points.dimension(); ++k) {
        entries.push_back({distance.row, point + k, 0.0});
      }
    }
  }
  for (const Quadratic& dot : dots_) append_positions(points, dot, dot_columns_, entries);
  bilinears_.append_positions(points, entries);
  for (const Linear& linear : linears_) {
    for (const auto& term : linear.terms) {
      entries.push_back({linear.row, term.coordinate, term.coefficient});  // Eq. (8)
    }
  }
  return from_entries(static_cast<int>(values_.size()), points.variables(), std::move(entries));
}

void Constraints::evaluate(const Points& points, Vector& Phi) const {
  const double* r = points.position();
  const int dimension = points.dimension();
  for (const Distance& distance : distances_) {
    double sum = 0.0;
    for (int k = 0; k < dimension; ++k) {
      const double u = r[distance.a + k] - r[distance.b + k];
      sum += u * u;
    }
    Phi(distance.row) = sum - values_[distance.row];  // Eq. (7)
  }
  for (const Quadratic& dot : dots_) {
    double sum = 0.0;
    for (int k = 0; k < dimension; ++k) {
      sum += (r[dot.a + k] - r[dot.b + k]) * (r[dot.c + k] - r[dot.d + k]);
    }
    Phi(dot.row) = sum - values_[dot.row];  // Eq. (7)
  }
  bilinears_.evaluate(points, values_, Phi);
  for (const Linear& linear : linears_) {
    double sum = -values_[linear.row];
    for (const auto& term : linear.terms) sum += term.coefficient * r[term.coordinate];
    Phi(linear.row) = sum;  // Eq. (8)
  }
}

void Constraints::evaluate_jacobian(const Points& points, SparseMatrix& Phi_q) const {
  const double* r = points.position();
  const int dimension = points.dimension();
  const int variables = points.variables();
  for (const Distance& distance : distances_) {
    for (int k = 0; k < dimension; ++k) {
      const double u = 2.0 * (r[distance.a + k] - r[distance.b + k]);
      if (distance.a < variables) Phi_q(distance.row, distance.a + k) = u;
      if (distance.b < variables) Phi_q(distance.row, distance.b + k) = -u;
    }
  }
  for (const Quadratic& dot : dots_) {
    for (int p = dot.columns_begin; p < dot.columns_end; ++p) {
      const Column& column = dot_columns_[p];
      for (int k = 0; k < dimension; ++k) {
        Phi_q(dot.row, column.point + k) = column.by_cd * (r[dot.c + k] - r[dot.d + k]) +
                                           column.by_ab * (r[dot.a + k] - r[dot.b + k]);
      }
    }
  }
  bilinears_.evaluate_jacobian(points, Phi_q);
}

void Constraints::evaluate_acceleration_term(const Points& points, Vector& term) const {
  const double* v = points.velocity();
  const int dimension = points.dimension();
  for (const Distance& distance : distances_) {
    double sum = 0.0;
    for (int k = 0; k < dimension; ++k) {
      const double u = v[distance.a + k] - v[distance.b + k];
      sum += u * u;
    }
    term(distance.row) = 2.0 * sum;  // Eq. (7)
  }
  for (const Quadratic& dot : dots_) {
    double sum = 0.0;
    for (int k = 0; k < dimension; ++k) {
      sum += (v[dot.a + k] - v[dot.b + k]) * (v[dot.c + k] - v[dot.d + k]);
    }
    term(dot.row) = 2.0 * sum;  // Eq. (7)
  }
  bilinears_.evaluate_acceleration_term(points, term);
  for (const Linear& linear : linears_) term(linear.row) = 0.0;  // Eq. (8)
}

}  // namespace mbs::ublas_sparse
