// Sampling of the drivers and the parts of Eqs. (7) and (8) that they alone give.
#include "drivers.hpp"

#include <algorithm>

namespace mbs::starting_sparse {
namespace {

constexpr std::array<std::array<double, 3>, 3> kIdentity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

}  // namespace

Drivers::Drivers(const Model& model, std::span<const int> point_offset)
    : model_(model), dimension_(model.dimension()) {
  std::vector<int> driven_offset(model.points().size(), 0);
  for (const DrivenPoint& driven : model.driven_points()) {
    point_offset_.push_back(point_offset[driven.point]);
    driven_offset[driven.point] = static_cast<int>(point_offset_.size()) * dimension_;
  }
  rate_.points.resize((point_offset_.size() + 1) * dimension_);
  second_.points = rate_.points;
  if (!point_offset_.empty()) find_terms(driven_offset);
  for (Term& term : terms_) {
    for (int& point : term.point) point = point_offset[point];
  }
  number_rows();
  for (const DrivenMass& mass : model.driven_mass()) {
    mass_driven_.push_back(driven_offset[mass.point]);
  }
  if (!mass_driven_.empty()) force_.assign(model.force().begin(), model.force().end());
}

/// Quadratic constraints that have a driven point; `row` and `point` as the model numbers them.
void Drivers::find_terms(std::span<const int> driven_offset) {
  int row = 0;
  const auto append = [&](const auto& constraint, const std::array<std::array<double, 3>, 3>& B) {
    Term term{row++, {constraint.a, constraint.b, constraint.c, constraint.d}, {}, B};
    bool is_driven = false;
    for (int k = 0; k < 4; ++k) {
      term.driven[k] = driven_offset[term.point[k]];
      is_driven = is_driven || term.driven[k] > 0;
    }
    if (is_driven) terms_.push_back(term);
  };
  for (const DotConstraint& constraint : model_.dot_constraints()) append(constraint, kIdentity);
  for (const BilinearConstraint& constraint : model_.bilinear_constraints()) {
    append(constraint, constraint.B);
  }
}

/// Collects rows_ and turns the rows of terms_ and of driven values into indices into it.
void Drivers::number_rows() {
  for (const Term& term : terms_) rows_.push_back(term.row);
  for (const DrivenValue& driven : model_.driven_values()) rows_.push_back(driven.constraint);
  std::sort(rows_.begin(), rows_.end());
  rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
  const auto index_of = [this](int row) {
    return static_cast<int>(std::lower_bound(rows_.begin(), rows_.end(), row) - rows_.begin());
  };
  for (Term& term : terms_) term.row = index_of(term.row);
  for (const DrivenValue& driven : model_.driven_values()) {
    value_row_.push_back(index_of(driven.constraint));
  }
  rate_.values.resize(rows_.size());
  second_.values.resize(rows_.size());
  result_.resize(rows_.size());
}

bool Drivers::empty() const { return point_offset_.empty() && value_row_.empty(); }

std::span<const double> Drivers::force() const {
  return force_.empty() ? model_.force() : std::span<const double>(force_);
}

void Drivers::drive(double t, double* q, double* v, double* value) {
  for (std::size_t i = 0; i < point_offset_.size(); ++i) {
    for (int axis = 0; axis < dimension_; ++axis) {
      const TimeFunction::Sample sample = model_.driven_points()[i].position[axis].at(t);
      q[point_offset_[i] + axis] = sample.value;
      v[point_offset_[i] + axis] = sample.rate;
      rate_.points[(i + 1) * dimension_ + axis] = sample.rate;
      second_.points[(i + 1) * dimension_ + axis] = sample.acceleration;
    }
  }
  for (std::size_t i = 0; i < value_row_.size(); ++i) {
    const DrivenValue& driven = model_.driven_values()[i];
    const TimeFunction::Sample sample = driven.value.at(t);
    value[driven.constraint] = sample.value;
    rate_.values[value_row_[i]] = sample.rate;
    second_.values[value_row_[i]] = sample.acceleration;
  }
  const std::span<const DrivenMass> masses = model_.driven_mass();
  for (const DrivenMass& mass : masses) force_[mass.coordinate] = model_.force()[mass.coordinate];
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double acceleration = second_.points[mass_driven_[i] + masses[i].axis];
    force_[masses[i].coordinate] -= masses[i].value * acceleration;
  }
}

std::span<const double> Drivers::evaluate(const Derivative& derivative, const double* q) {
  const double* given = derivative.points.data();
  for (std::size_t k = 0; k < rows_.size(); ++k) result_[k] = -derivative.values[k];  // Eq. (8)
  for (const Term& term : terms_) {
    const auto& [a, b, c, d] = term.point;
    const auto& [ga, gb, gc, gd] = term.driven;
    double sum = 0.0;
    for (int i = 0; i < dimension_; ++i) {
      double Bw = 0.0, Bw_given = 0.0;
      for (int j = 0; j < dimension_; ++j) {
        Bw += term.B[i][j] * (q[c + j] - q[d + j]);
        Bw_given += term.B[i][j] * (given[gc + j] - given[gd + j]);
      }
      sum += (given[ga + i] - given[gb + i]) * Bw + (q[a + i] - q[b + i]) * Bw_given;
    }
    result_[term.row] += sum;  // Eq. (7)
  }
  return result_;
}

}  // namespace mbs::starting_sparse
