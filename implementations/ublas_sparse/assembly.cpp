// Lowers the constraints of a Model to flat arrays and evaluates them.
#include "assembly.hpp"

#include <algorithm>
#include <utility>

namespace mbs::ublas_sparse {

Constraints::Constraints(const Model& model)
    : variables_(model.variables()),
      constraints_(model.constraints()),
      dimension_(model.dimension()),
      position_(model.variables()) {
  std::vector<int> first;  // first coordinate of every point
  for (const Point& point : model.points()) {
    first.push_back(point.is_fixed() ? static_cast<int>(position_.size()) : point.offset);
    if (!point.is_fixed()) continue;
    position_.insert(position_.end(), point.position.begin(), point.position.begin() + dimension_);
  }
  velocity_.assign(position_.size(), 0.0);

  int row = 0;
  for (const DotConstraint& dot : model.dot_constraints()) {
    if (dot.a == dot.c && dot.b == dot.d && dot.a != dot.b) {
      distances_.push_back({row++, first[dot.a], first[dot.b], dot.value});
    } else {
      add_dot({row++, first[dot.a], first[dot.b], first[dot.c], first[dot.d], dot.value, 0, 0});
    }
  }
  for (const LinearConstraint& linear : model.linear_constraints()) {
    linears_.push_back({row++, linear.value, linear.terms});
  }
}

void Constraints::add_dot(const Dot& dot) {
  const int begin = static_cast<int>(dot_columns_.size());
  const auto add = [&](int point, double by_cd, double by_ab) {
    if (point >= variables_) return;  // fixed
    const auto same = std::find_if(dot_columns_.begin() + begin, dot_columns_.end(),
                                   [&](const DotColumn& column) { return column.point == point; });
    if (same == dot_columns_.end()) {
      dot_columns_.push_back({point, by_cd, by_ab});
    } else {
      same->by_cd += by_cd;
      same->by_ab += by_ab;
    }
  };
  add(dot.a, 1, 0);
  add(dot.b, -1, 0);
  add(dot.c, 0, 1);
  add(dot.d, 0, -1);
  dots_.push_back(dot);
  dots_.back().columns_begin = begin;
  dots_.back().columns_end = static_cast<int>(dot_columns_.size());
}

SparseMatrix Constraints::jacobian_storage() const {
  std::vector<Entry> entries;
  const auto add_point = [&](int row, int point) {
    if (point >= variables_) return;
    for (int k = 0; k < dimension_; ++k) entries.push_back({row, point + k, 0.0});
  };
  for (const Distance& distance : distances_) {
    add_point(distance.row, distance.a);
    add_point(distance.row, distance.b);
  }
  for (const Dot& dot : dots_) {
    for (int p = dot.columns_begin; p < dot.columns_end; ++p) {
      add_point(dot.row, dot_columns_[p].point);
    }
  }
  for (const Linear& linear : linears_) {
    for (const auto& term : linear.terms) {
      entries.push_back({linear.row, term.coordinate, term.coefficient});  // Eq. (8)
    }
  }
  return from_entries(constraints_, variables_, std::move(entries));
}

void Constraints::move_to(std::span<const double> q) { std::ranges::copy(q, position_.begin()); }

void Constraints::evaluate(Vector& Phi) const {
  const double* r = position_.data();
  for (const Distance& distance : distances_) {
    double sum = 0.0;
    for (int k = 0; k < dimension_; ++k) {
      const double u = r[distance.a + k] - r[distance.b + k];
      sum += u * u;
    }
    Phi(distance.row) = sum - distance.value;  // Eq. (7)
  }
  for (const Dot& dot : dots_) {
    double sum = 0.0;
    for (int k = 0; k < dimension_; ++k) {
      sum += (r[dot.a + k] - r[dot.b + k]) * (r[dot.c + k] - r[dot.d + k]);
    }
    Phi(dot.row) = sum - dot.value;  // Eq. (7)
  }
  for (const Linear& linear : linears_) {
    double sum = -linear.value;
    for (const auto& term : linear.terms) sum += term.coefficient * r[term.coordinate];
    Phi(linear.row) = sum;  // Eq. (8)
  }
}

void Constraints::evaluate_jacobian(SparseMatrix& Phi_q) const {
  const double* r = position_.data();
  for (const Distance& distance : distances_) {
    for (int k = 0; k < dimension_; ++k) {
      const double u = 2.0 * (r[distance.a + k] - r[distance.b + k]);
      if (distance.a < variables_) Phi_q(distance.row, distance.a + k) = u;
      if (distance.b < variables_) Phi_q(distance.row, distance.b + k) = -u;
    }
  }
  for (const Dot& dot : dots_) {
    for (int p = dot.columns_begin; p < dot.columns_end; ++p) {
      const DotColumn& column = dot_columns_[p];
      for (int k = 0; k < dimension_; ++k) {
        Phi_q(dot.row, column.point + k) = column.by_cd * (r[dot.c + k] - r[dot.d + k]) +
                                           column.by_ab * (r[dot.a + k] - r[dot.b + k]);
      }
    }
  }
}

void Constraints::evaluate_acceleration_term(const Vector& v, Vector& term) {
  std::copy(v.begin(), v.end(), velocity_.begin());
  const double* w = velocity_.data();
  for (const Distance& distance : distances_) {
    double sum = 0.0;
    for (int k = 0; k < dimension_; ++k) {
      const double u = w[distance.a + k] - w[distance.b + k];
      sum += u * u;
    }
    term(distance.row) = 2.0 * sum;  // Eq. (7)
  }
  for (const Dot& dot : dots_) {
    double sum = 0.0;
    for (int k = 0; k < dimension_; ++k) {
      sum += (w[dot.a + k] - w[dot.b + k]) * (w[dot.c + k] - w[dot.d + k]);
    }
    term(dot.row) = 2.0 * sum;  // Eq. (7)
  }
  for (const Linear& linear : linears_) term(linear.row) = 0.0;  // Eq. (8)
}

}  // namespace mbs::ublas_sparse
