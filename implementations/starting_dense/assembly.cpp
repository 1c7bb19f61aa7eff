// Lowers the constraints to flat arrays at construction; evaluates with full dense products.
#include "assembly.hpp"

namespace mbs::starting_dense {

Assembly::Assembly(const Model& model)
    : dimension_(model.dimension()),
      M_(model.variables(), model.variables()),
      Q_(model.force().begin(), model.force().end()),
      extended_position_(model.initial_position().begin(), model.initial_position().end()),
      phi_(model.constraints()),
      Phi_q_(model.constraints(), model.variables()),
      Phi_q_transposed_(model.variables(), model.constraints()),
      Phi_q_dot_v_(model.constraints()),
      product_(model.variables()) {
  for (const MassEntry& entry : model.mass()) {
    M_(entry.row, entry.col) = entry.value;
    M_(entry.col, entry.row) = entry.value;
  }
  std::vector<int> at;  // where each point is in extended coordinates
  for (const Point& point : model.points()) {
    at.push_back(point.is_fixed() ? static_cast<int>(extended_position_.size()) : point.offset);
    if (!point.is_fixed()) continue;
    extended_position_.insert(extended_position_.end(), point.position.begin(),
                              point.position.begin() + dimension_);
  }
  for (const DotConstraint& constraint : model.dot_constraints()) add_dot(model, constraint, at);
  int row = static_cast<int>(dots_.size());
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    add_linear(constraint, row++);
  }
}

void Assembly::add_dot(const Model& model, const DotConstraint& constraint,
                       const std::vector<int>& at) {
  const std::array<int, 4> points{constraint.a, constraint.b, constraint.c, constraint.d};
  const int begin = static_cast<int>(blocks_.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int point = points[i];
    bool repeated = false;
    for (std::size_t k = 0; k < i; ++k) repeated = repeated || points[k] == point;
    if (repeated || model.points()[point].is_fixed()) continue;
    // Eq. (7), the Jacobian row: added up where points coincide.
    const double ab = (point == constraint.c) - (point == constraint.d);
    const double cd = (point == constraint.a) - (point == constraint.b);
    blocks_.push_back({at[point], ab, cd});
  }
  dots_.push_back({at[constraint.a], at[constraint.b], at[constraint.c], at[constraint.d], begin,
                   static_cast<int>(blocks_.size()), constraint.value});
}

void Assembly::add_linear(const LinearConstraint& constraint, int row) {
  for (const LinearConstraint::Term& term : constraint.terms) {
    Phi_q_(row, term.coordinate) = term.coefficient;
    terms_.push_back(term);
  }
  terms_end_.push_back(static_cast<int>(terms_.size()));
  linear_values_.push_back(constraint.value);
}

void Assembly::evaluate(const Vector& q) {
  const int dots = static_cast<int>(dots_.size());
  const int linear = static_cast<int>(linear_values_.size());
  for (int row = 0; row < dots; ++row) evaluate_dot(row, q);
  int k = 0;
  for (int row = 0; row < linear; ++row) {  // Eq. (8)
    double sum = -linear_values_[row];
    for (; k < terms_end_[row]; ++k) sum += terms_[k].coefficient * q[terms_[k].coordinate];
    phi_[dots + row] = sum;
  }
  transpose(Phi_q_, Phi_q_transposed_);
}

void Assembly::evaluate_dot(int row, const Vector& q) {
  const Dot& dot = dots_[row];
  double sum = 0.0;
  for (int x = 0; x < dimension_; ++x) {  // Eq. (7)
    const double ab = q[dot.a + x] - q[dot.b + x];
    const double cd = q[dot.c + x] - q[dot.d + x];
    sum += ab * cd;
    for (int k = dot.blocks_begin; k < dot.blocks_end; ++k) {
      const Block& block = blocks_[k];
      Phi_q_(row, block.coordinate + x) = block.ab * ab + block.cd * cd;
    }
  }
  phi_[row] = sum - dot.value;
}

void Assembly::residual(const Vector& a, const Vector& multipliers, Vector& right) {
  matmul(M_, a, right);
  matmul(Phi_q_transposed_, multipliers, product_);
  for (std::size_t i = 0; i < right.size(); ++i) right[i] += product_[i] - Q_[i];
}

void Assembly::tangent(double factor, Matrix& result) {
  matmul(Phi_q_transposed_, Phi_q_, result);
  const double* mass = M_.data();
  double* values = result.data();
  for (std::size_t i = 0; i < result.size(); ++i) values[i] = mass[i] + factor * values[i];
}

void Assembly::acceleration_right(const Vector& a, const Vector& v, double factor, Vector& right) {
  const int dots = static_cast<int>(dots_.size());
  for (int row = 0; row < dots; ++row) {  // Eq. (7)
    const Dot& dot = dots_[row];
    double sum = 0.0;
    for (int x = 0; x < dimension_; ++x) {
      sum += (v[dot.a + x] - v[dot.b + x]) * (v[dot.c + x] - v[dot.d + x]);
    }
    Phi_q_dot_v_[row] = 2.0 * sum;
  }
  matmul(M_, a, right);
  matmul(Phi_q_transposed_, Phi_q_dot_v_, product_);
  for (std::size_t i = 0; i < right.size(); ++i) right[i] -= factor * product_[i];
}

}  // namespace mbs::starting_dense
