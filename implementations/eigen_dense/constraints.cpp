// The constraints in flat arrays: Phi, Phi_q and the quadratic part of the velocity term.
#include "constraints.hpp"

#include <algorithm>

namespace mbs::eigen_dense {

template <typename Scalar>
Constraints<Scalar>::Constraints(const Model& model, const Layout& layout)
    : variables_(layout.variables()),
      dimension_(layout.dimension()),
      quadratic_(model.constraints() - static_cast<Index>(model.linear_constraints().size())),
      Phi_(Vector::Zero(model.constraints())),
      jacobian_(Vector::Zero(variables_ * Phi_.size() + dimension_)) {
  Index row = 0;
  for (const auto& constraint : model.dot_constraints()) lower_dot(constraint, row++, layout);
  for (const auto& constraint : model.bilinear_constraints()) {
    lower_bilinear(constraint, row++, layout);
  }
  for (const auto& constraint : model.linear_constraints()) lower_linear(constraint, row++);
  list_coordinates(model, layout);
  clear_driven_values(model);
}

template <typename Scalar>
template <typename Constraint>
typename Constraints<Scalar>::Dot Constraints<Scalar>::slotted(const Constraint& constraint,
                                                               Index row,
                                                               const Layout& layout) const {
  const int a = constraint.a, b = constraint.b, c = constraint.c, d = constraint.d;
  Dot dot{layout.start(a),         layout.start(b), layout.start(c), layout.start(d), {}, row,
          Scalar(constraint.value)};
  dot.slots.fill({variables_ * Phi_.size(), 0, 0});
  std::size_t k = 0;
  for (const Share& share : layout.shares({a, b, c, d})) {
    dot.slots[k++] = {row * variables_ + share.start, Scalar(share.in_w), Scalar(share.in_u)};
  }
  return dot;
}

template <typename Scalar>
void Constraints<Scalar>::lower_dot(const DotConstraint& constraint, Index row,
                                    const Layout& layout) {
  if (constraint.a != constraint.c || constraint.b != constraint.d) {
    dots_.push_back(slotted(constraint, row, layout));
    return;
  }
  const Index a = layout.start(constraint.a), b = layout.start(constraint.b);
  const auto to = [&](Index start) {
    return start < variables_ ? row * variables_ + start : variables_ * Phi_.size();
  };
  distances_.push_back({a, b, to(a), to(b), row, Scalar(constraint.value)});
}

template <typename Scalar>
void Constraints<Scalar>::lower_bilinear(const BilinearConstraint& constraint, Index row,
                                         const Layout& layout) {
  Bilinear bilinear{slotted(constraint, row, layout), Eigen::Matrix<Scalar, 3, 3>::Zero()};
  for (int i = 0; i < dimension_; ++i) {
    for (int j = 0; j < dimension_; ++j) bilinear.B(i, j) = Scalar(constraint.B[i][j]);
  }
  bilinears_.push_back(bilinear);
}

template <typename Scalar>
void Constraints<Scalar>::lower_linear(const LinearConstraint& constraint, Index row) {
  const Index begin = static_cast<Index>(terms_.size());
  for (const auto& [coordinate, coefficient] : constraint.terms) {
    terms_.push_back({coordinate, Scalar(coefficient)});
    jacobian_[row * variables_ + coordinate] = Scalar(coefficient);  // Eq. (8), once and for all
  }
  linears_.push_back({begin, static_cast<Index>(terms_.size()), row, Scalar(constraint.value)});
}

template <typename Scalar>
void Constraints<Scalar>::list_coordinates(const Model& model, const Layout& layout) {
  const auto end = [this] { ends_.push_back(static_cast<Index>(coordinates_.size())); };
  const auto list_points = [&](const auto& one) {
    for (const Share& share : layout.shares({one.a, one.b, one.c, one.d})) {
      for (int axis = 0; axis < dimension_; ++axis) coordinates_.push_back(share.start + axis);
    }
    end();
  };
  for (const auto& constraint : model.dot_constraints()) list_points(constraint);
  for (const auto& constraint : model.bilinear_constraints()) list_points(constraint);
  for (const auto& constraint : model.linear_constraints()) {
    for (const auto& [coordinate, _] : constraint.terms) coordinates_.push_back(coordinate);
    end();
  }
}

template <typename Scalar>
void Constraints<Scalar>::clear_driven_values(const Model& model) {
  if (model.driven_values().empty()) return;
  std::vector<Scalar*> values(Phi_.size());
  for (Distance& distance : distances_) values[distance.row] = &distance.value;
  for (Dot& dot : dots_) values[dot.row] = &dot.value;
  for (Bilinear& bilinear : bilinears_) values[bilinear.dot.row] = &bilinear.dot.value;
  for (Linear& linear : linears_) values[linear.row] = &linear.value;
  for (const DrivenValue& driven : model.driven_values()) *values[driven.constraint] = 0;
}

template <typename Scalar>
template <int dimension>
void Constraints<Scalar>::evaluate_quadratic(const Scalar* q, bool jacobian) {
  using Point = Eigen::Matrix<Scalar, dimension, 1>;
  const auto entry = [start = jacobian_.data()](Index to) { return Eigen::Map<Point>(start + to); };
  Scalar* const Phi = Phi_.data();
  for (const Distance& distance : distances_) {  // Eq. (7) with a = c, b = d
    const Point ab = difference<dimension>(q, distance.a, distance.b);
    Phi[distance.row] = ab.squaredNorm() - distance.value;
    if (!jacobian) continue;
    entry(distance.to_a) = Scalar(2) * ab;
    entry(distance.to_b) = Scalar(-2) * ab;
  }
  const auto write_slots = [&](const Dot& dot, const Point& ab, const Point& cd) {
    for (const auto& slot : dot.slots) entry(slot.to) = slot.ab * ab + slot.cd * cd;
  };
  for (const Dot& dot : dots_) {  // Eq. (7)
    const Point ab = difference<dimension>(q, dot.a, dot.b);
    const Point cd = difference<dimension>(q, dot.c, dot.d);
    Phi[dot.row] = ab.dot(cd) - dot.value;
    if (jacobian) write_slots(dot, ab, cd);
  }
  for (const auto& [dot, full_B] : bilinears_) {  // Eq. (7)
    const auto B = full_B.template topLeftCorner<dimension, dimension>();
    const Point ab = difference<dimension>(q, dot.a, dot.b);
    const Point Bcd = B * difference<dimension>(q, dot.c, dot.d);
    Phi[dot.row] = ab.dot(Bcd) - dot.value;
    if (jacobian) write_slots(dot, B.transpose() * ab, Bcd);
  }
}

template <typename Scalar>
void Constraints<Scalar>::evaluate(const Vector& q, bool jacobian) {
  dimension_ == 2 ? evaluate_quadratic<2>(q.data(), jacobian)
                  : evaluate_quadratic<3>(q.data(), jacobian);
  for (const Linear& linear : linears_) {  // Eq. (8)
    Scalar sum = -linear.value;
    for (Index k = linear.begin; k < linear.end; ++k) {
      sum += terms_[k].coefficient * q[terms_[k].coordinate];
    }
    Phi_[linear.row] = sum;
  }
}

template <typename Scalar>
template <int dimension>
void Constraints<Scalar>::evaluate_velocity_term(const Scalar* v, Scalar* term) const {
  for (const Distance& distance : distances_) {  // Eq. (7)
    term[distance.row] = Scalar(2) * difference<dimension>(v, distance.a, distance.b).squaredNorm();
  }
  for (const Dot& dot : dots_) {
    term[dot.row] =
        Scalar(2) *
        difference<dimension>(v, dot.a, dot.b).dot(difference<dimension>(v, dot.c, dot.d));
  }
  for (const auto& [dot, B] : bilinears_) {
    term[dot.row] = Scalar(2) * difference<dimension>(v, dot.a, dot.b)
                                    .dot(B.template topLeftCorner<dimension, dimension>() *
                                         difference<dimension>(v, dot.c, dot.d));
  }
}

template <typename Scalar>
void Constraints<Scalar>::velocity_term(const Vector& v, Vector& term) const {
  dimension_ == 2 ? evaluate_velocity_term<2>(v.data(), term.data())
                  : evaluate_velocity_term<3>(v.data(), term.data());
}

template <typename Scalar>
void Constraints<Scalar>::add_product(const Vector& x, Vector& y) const {
  const Scalar* column = jacobian_.data();
  Index k = 0;
  for (std::size_t row = 0; row < ends_.size(); ++row, column += variables_) {
    Scalar sum = 0;
    for (; k < ends_[row]; ++k) sum += column[coordinates_[k]] * x[coordinates_[k]];
    y[row] += sum;
  }
}

template <typename Scalar>
void Constraints<Scalar>::add_transposed_product(Scalar factor, const Vector& x, Vector& y) const {
  const Scalar* column = jacobian_.data();
  Index k = 0;
  for (std::size_t row = 0; row < ends_.size(); ++row, column += variables_) {
    const Scalar scaled = factor * x[row];
    for (; k < ends_[row]; ++k) y[coordinates_[k]] += scaled * column[coordinates_[k]];
  }
}

template <typename Scalar>
void Constraints<Scalar>::add_linear_share(Scalar factor, Matrix& T) const {
  for (const Linear& linear : linears_) {
    for (Index j = linear.begin; j < linear.end; ++j) {
      for (Index i = linear.begin; i < linear.end; ++i) {
        T(terms_[i].coordinate, terms_[j].coordinate) +=
            factor * terms_[i].coefficient * terms_[j].coefficient;
      }
    }
  }
}

template class Constraints<double>;
template class Constraints<float>;

}  // namespace mbs::eigen_dense
