// Phi and Phi_q; equations are those of paper/README.md.
#include "constraints.hpp"

#include <algorithm>

namespace mbs::csc_ldl {

Constraints::Constraints(const Model& model, const Coordinates& at)
    : dimension_(model.dimension()) {
  const std::span<const DotConstraint> dots = model.dot_constraints();
  const std::span<const BilinearConstraint> bilinear = model.bilinear_constraints();
  const int all_dots = static_cast<int>(dots.size());
  const int distances = static_cast<int>(std::ranges::count_if(dots, &DotConstraint::is_distance));
  const int all_bilinear = static_cast<int>(bilinear.size());
  distances_ = Group(distances, 1, at);
  dots_ = Group(all_dots - distances, 2, at);
  bilinear_ = Group(all_bilinear, 2, at);

  for (const bool wanted : {true, false}) {
    Group& group = wanted ? distances_ : dots_;
    int k = 0;
    for (int row = 0; row < all_dots; ++row) {
      const DotConstraint& dot = dots[row];
      if (dot.is_distance() != wanted) continue;
      group.set_points(k, 0, dot.a, dot.b, at);
      if (!wanted) group.set_points(k, 1, dot.c, dot.d, at);
      model_row_.push_back(row);
      value_.push_back(dot.value);
      ++k;
    }
  }
  B_.resize(dimension_ * dimension_ * all_bilinear);
  for (int k = 0; k < all_bilinear; ++k) {
    bilinear_.set_points(k, 0, bilinear[k].a, bilinear[k].b, at);
    bilinear_.set_points(k, 1, bilinear[k].c, bilinear[k].d, at);
    for (int r = 0; r < dimension_; ++r) {
      for (int c = 0; c < dimension_; ++c) {
        B_[(r * dimension_ + c) * all_bilinear + k] = bilinear[k].B[r][c];
      }
    }
    model_row_.push_back(all_dots + k);
    value_.push_back(bilinear[k].value);
  }
  int first = 0;
  for (Group* group : {&distances_, &dots_, &bilinear_}) {
    if (group->count == 0) continue;
    groups_.push_back({group, first});
    first += group->count;
    group->first_force = force_parts_;
    group->first_matrix = matrix_parts_;
    force_parts_ += group->force_parts();
    matrix_parts_ += group->matrix_parts();
  }

  first_linear_ = all_dots + all_bilinear;
  first_linear_part_ = force_parts_;
  linear_begin_ = {0};
  for (const LinearConstraint& linear : model.linear_constraints()) {
    for (const LinearConstraint::Term& term : linear.terms) {
      linear_variable_.push_back(at.state()[term.coordinate]);
      linear_coefficient_.push_back(term.coefficient);
    }
    linear_begin_.push_back(static_cast<int>(linear_variable_.size()));
    model_row_.push_back(static_cast<int>(model_row_.size()));
    value_.push_back(linear.value);
  }
  force_parts_ += static_cast<int>(linear_variable_.size());

  for (std::vector<double>* each : {&Phi, &value_rate_, &value_acceleration_}) {
    each->resize(count());
  }
  for (const DrivenValue& driven : model.driven_values()) {
    driven_.push_back(
        {static_cast<int>(std::ranges::find(model_row_, driven.constraint) - model_row_.begin()),
         driven.value});
  }
}

void Constraints::visit_forces(const Visit& visit) const {
  for (const auto& [group, first] : groups_) {
    for (int k = 0; k < group->count; ++k) {
      for (const Group::End& end : group->ends(k)) {
        visit(first + k, end.variable, group->force_part(k, end));
      }
    }
  }
  for (int row = first_linear_; row < count(); ++row) {
    for (int t = linear_begin_[row - first_linear_]; t < linear_begin_[row - first_linear_ + 1];
         ++t) {
      visit(row, linear_variable_[t], first_linear_part_ + t);
    }
  }
}

void Constraints::visit_products(const Visit& visit) const {
  for (const auto& [group, first] : groups_) group->visit_products(visit);
}

void Constraints::visit_linear(
    const std::function<void(int i, int j, double product)>& visit) const {
  for (std::size_t l = 0; l + 1 < linear_begin_.size(); ++l) {
    for (int s = linear_begin_[l]; s < linear_begin_[l + 1]; ++s) {
      for (int t = linear_begin_[l]; t < linear_begin_[l + 1]; ++t) {
        visit(linear_variable_[s], linear_variable_[t],
              linear_coefficient_[s] * linear_coefficient_[t]);
      }
    }
  }
}

void Constraints::drive(double t) {
  for (const DrivenRow& driven : driven_) {
    const TimeFunction::Sample s = driven.value.at(t);
    value_[driven.row] = s.value;
    value_rate_[driven.row] = s.rate;
    value_acceleration_[driven.row] = s.acceleration;
  }
}

void Constraints::evaluate(const double* q) {
  dimension_ == 2 ? evaluate_dots<2>(q) : evaluate_dots<3>(q);
  for (int row = first_linear_; row < count(); ++row) {
    Phi[row] = linear_product(row, q) - value_[row];  // Eq. (8)
  }
}

// Eq. (7).
template <int dimension>
void Constraints::evaluate_dots(const double* q) {
  {
    const int count = distances_.count;
    const int *plus = distances_.plus.data(), *minus = distances_.minus.data();
    const double* __restrict value = value_.data();
    double* __restrict gradient = distances_.gradient.data();
    double* __restrict result = Phi.data();
    for (int k = 0; k < count; ++k) {
      double u_u = 0.0;
      for (int c = 0; c < dimension; ++c) {
        const double u = q[plus[c * count + k]] - q[minus[c * count + k]];
        gradient[c * count + k] = 2 * u;
        u_u += u * u;
      }
      result[k] = u_u - value[k];
    }
  }
  for (int k = 0; k < dots_.count; ++k) {
    const int row = distances_.count + k;
    double u_w = 0.0;
    for (int c = 0; c < dimension; ++c) {
      const double u = dots_.difference(q, c, k), w = dots_.difference(q, dimension + c, k);
      dots_.gradient[c * dots_.count + k] = w;
      dots_.gradient[(dimension + c) * dots_.count + k] = u;
      u_w += u * w;
    }
    Phi[row] = u_w - value_[row];
  }
  const int count = bilinear_.count;
  for (int k = 0; k < count; ++k) {
    const int row = distances_.count + dots_.count + k;
    double B_w[dimension] = {}, Bt_u[dimension] = {}, u_B_w = 0.0;
    for (int r = 0; r < dimension; ++r) {
      const double u = bilinear_.difference(q, r, k);
      for (int c = 0; c < dimension; ++c) {
        const double B = B_[(r * dimension + c) * count + k];
        B_w[r] += B * bilinear_.difference(q, dimension + c, k);
        Bt_u[c] += B * u;
      }
      u_B_w += u * B_w[r];
    }
    for (int c = 0; c < dimension; ++c) {
      bilinear_.gradient[c * count + k] = B_w[c];
      bilinear_.gradient[(dimension + c) * count + k] = Bt_u[c];
    }
    Phi[row] = u_B_w - value_[row];
  }
}

void Constraints::rate(double* result) const {
  std::fill_n(result, count(), 0.0);
  for (const DrivenRow& driven : driven_) result[driven.row] -= value_rate_[driven.row];
}

void Constraints::second_rate(const double* v, double* result) const {
  dimension_ == 2 ? write_squares<2>(v, result) : write_squares<3>(v, result);
  for (const DrivenRow& driven : driven_) result[driven.row] -= value_acceleration_[driven.row];
}

void Constraints::add_product(const double* x, double* y) const {
  for (const auto& [group, first] : groups_) group->add_contracted(x, y + first);
  for (int row = first_linear_; row < count(); ++row) y[row] += linear_product(row, x);
}

void Constraints::write_reactions(double factor, const double* x, const double* y,
                                  double* parts) const {
  for (const auto& [group, first] : groups_) group->write_reactions(factor, x, y + first, parts);
  double* part = parts + first_linear_part_;
  for (int row = first_linear_, t = 0; row < count(); ++row) {
    const double sum = factor * (y[row] + linear_product(row, x));
    for (; t < linear_begin_[row - first_linear_ + 1]; ++t) part[t] = linear_coefficient_[t] * sum;
  }
}

double Constraints::linear_product(int row, const double* x) const {
  double sum = 0.0;
  for (int t = linear_begin_[row - first_linear_]; t < linear_begin_[row - first_linear_ + 1];
       ++t) {
    sum += linear_coefficient_[t] * x[linear_variable_[t]];
  }
  return sum;
}

void Constraints::write_forces(const double* g, double* parts) const {
  for (const auto& [group, first] : groups_) {
    const double* of_group = g + first;
    group->write_forces([=](int k) { return of_group[k]; }, parts);
  }
  double* part = parts + first_linear_part_;
  for (int row = first_linear_, t = 0; row < count(); ++row) {
    for (; t < linear_begin_[row - first_linear_ + 1]; ++t)
      part[t] = linear_coefficient_[t] * g[row];
  }
}

void Constraints::write_products(double factor, double* parts) const {
  for (const auto& [group, first] : groups_) {
    group->write_products([=](int) { return factor; }, parts);
  }
}

template <int dimension>
void Constraints::write_squares(const double* v, double* __restrict result) const {
  for (int k = 0; k < distances_.count; ++k) {
    double sum = 0.0;
    for (int c = 0; c < dimension; ++c) {
      const double u = distances_.difference(v, c, k);
      sum += u * u;
    }
    result[k] = 2 * sum;
  }
  for (int k = 0; k < dots_.count; ++k) {
    double sum = 0.0;
    for (int c = 0; c < dimension; ++c) {
      sum += dots_.difference(v, c, k) * dots_.difference(v, dimension + c, k);
    }
    result[distances_.count + k] = 2 * sum;
  }
  for (int k = 0; k < bilinear_.count; ++k) {
    double sum = 0.0;
    for (int r = 0; r < dimension; ++r) {
      for (int c = 0; c < dimension; ++c) {
        sum += bilinear_.difference(v, r, k) * B_[(r * dimension + c) * bilinear_.count + k] *
               bilinear_.difference(v, dimension + c, k);
      }
    }
    result[distances_.count + dots_.count + k] = 2 * sum;
  }
  std::fill_n(result + first_linear_, count() - first_linear_, 0.0);
}

}  // namespace mbs::csc_ldl
