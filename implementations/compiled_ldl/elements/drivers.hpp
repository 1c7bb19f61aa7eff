// What is known as a function of time: points, values of constraints, the forces of driven mass.
#pragma once

#include "elements/constraints.hpp"

namespace mbs::compiled_ldl {

/// A driven point A on rows 16-17 and a rod A - B, constraint 0, of driven length: point_rows_ =
/// {16}, touched_ = {0}, values_ = {{0, 0, ṡ, s̈}}.
template <typename S, int D>
class Drivers {
 public:
  Drivers(std::span<const Model* const> models, const Rows& rows, const Constraints<S, D>& all);

  [[nodiscard]] bool any() const { return any_; }
  /// Positions and velocities of driven points, values of constraints, force = Q's constant part.
  void drive(double t, S* q, S* v, Constraints<S, D>& constraints, S* force);
  /// t = Φt.
  void rate_terms(const Constraints<S, D>& constraints, S* t) const;
  /// t = Φ̇q v + Φ̇t.
  void acceleration_terms(const Constraints<S, D>& constraints, const S* v, S* t) const;
  /// y −= f Φqᵀ Φt, or that of what drivers add to Φ̇q v + Φ̇t.
  void add_rate_terms(const Constraints<S, D>& constraints, const S& f, S* y) const;
  void add_acceleration_terms(const Constraints<S, D>& constraints, const S& f, S* y) const;
  /// t −= ṡ: makes Φq v + Φt of the product with all columns.
  void subtract_rates(S* t) const {
    for (const Value& value : values_) t[value.constraint] -= value.rate;
  }

 private:
  struct Value {
    int driven, constraint;
    S rate, acceleration;
  };
  struct Mass {
    int row, point_row;
    S value;
  };

  std::vector<const Model*> models_;
  bool any_;
  std::vector<int> point_rows_;
  std::vector<int> touched_;  // constraints with a driven point
  std::vector<Value> values_;
  std::vector<Mass> mass_;
  Array<S> velocity_, acceleration_;  // of fixed points; zero elsewhere
  Array<S> constant_;
};

template <typename S, int D>
Drivers<S, D>::Drivers(std::span<const Model* const> models, const Rows& rows,
                       const Constraints<S, D>& all)
    : models_(models.begin(), models.end()) {
  const Model& first = *models[0];
  constant_.resize(rows.extent, S(0.0));
  for (int i = 0; i < first.variables(); ++i) {
    constant_[rows.of_coordinate[i]] =
        of_models<S>(models, [&](const Model& m) { return m.force()[i]; });
  }
  any_ = !first.driven_points().empty() || !first.driven_values().empty();
  if (!any_) return;
  velocity_.resize(rows.extent, S(0.0));
  acceleration_.resize(rows.extent, S(0.0));
  for (const DrivenPoint& point : first.driven_points()) {
    point_rows_.push_back(rows.of_point[point.point]);
  }
  for (int k = 0; k < all.count(); ++k) {
    if (all.touches(k, point_rows_)) touched_.push_back(k);
  }
  for (int i = 0; i < static_cast<int>(first.driven_values().size()); ++i) {
    for (int k = 0; k < all.count(); ++k) {
      if (all.number(k) != first.driven_values()[i].constraint) continue;
      values_.push_back({i, k, S(0.0), S(0.0)});
    }
  }
  for (int i = 0; i < static_cast<int>(first.driven_mass().size()); ++i) {
    const DrivenMass& mass = first.driven_mass()[i];
    mass_.push_back(
        {rows.of_coordinate[mass.coordinate], rows.of_point[mass.point] + mass.axis,
         of_models<S>(models, [&](const Model& m) { return m.driven_mass()[i].value; })});
  }
}

template <typename S, int D>
void Drivers<S, D>::drive(double t, S* q, S* v, Constraints<S, D>& constraints, S* force) {
  std::copy(constant_.begin(), constant_.end(), force);
  if (!any_) return;
  const int lanes = static_cast<int>(models_.size());
  const auto sample = [&](auto get, S& value, S& rate, S& acceleration) {
    for (int i = 0; i < lanes; ++i) {
      const TimeFunction::Sample at = get(*models_[i]).at(t);
      set_lane(value, i, at.value);
      set_lane(rate, i, at.rate);
      set_lane(acceleration, i, at.acceleration);
    }
  };
  for (std::size_t i = 0; i < point_rows_.size(); ++i) {
    for (int x = 0; x < D; ++x) {
      const int row = point_rows_[i] + x;
      const auto get = [&](const Model& m) -> const TimeFunction& {
        return m.driven_points()[i].position[x];
      };
      sample(get, q[row], velocity_[row], acceleration_[row]);
      v[row] = velocity_[row];
    }
  }
  for (Value& value : values_) {
    const auto get = [&](const Model& m) -> const TimeFunction& {
      return m.driven_values()[value.driven].value;
    };
    sample(get, constraints.value(value.constraint), value.rate, value.acceleration);
  }
  for (const Mass& mass : mass_) force[mass.row] -= mass.value * acceleration_[mass.point_row];
}

template <typename S, int D>
void Drivers<S, D>::rate_terms(const Constraints<S, D>& constraints, S* t) const {
  std::fill_n(t, constraints.count(), S(0.0));
  for (const int k : touched_) t[k] = constraints.product_of(k, velocity_.data());
  subtract_rates(t);
}

template <typename S, int D>
void Drivers<S, D>::acceleration_terms(const Constraints<S, D>& constraints, const S* v,
                                       S* t) const {
  constraints.velocity_terms(v, t);
  if (!any_) return;
  for (const int k : touched_) t[k] += constraints.product_of(k, acceleration_.data());
  for (const Value& value : values_) t[value.constraint] -= value.acceleration;
}

template <typename S, int D>
void Drivers<S, D>::add_rate_terms(const Constraints<S, D>& constraints, const S& f, S* y) const {
  for (const int k : touched_) {
    constraints.add_gradient(k, -f * constraints.product_of(k, velocity_.data()), y);
  }
  for (const Value& value : values_) {
    constraints.add_gradient(value.constraint, f * value.rate, y);
  }
}

template <typename S, int D>
void Drivers<S, D>::add_acceleration_terms(const Constraints<S, D>& constraints, const S& f,
                                           S* y) const {
  for (const int k : touched_) {
    constraints.add_gradient(k, -f * constraints.product_of(k, acceleration_.data()), y);
  }
  for (const Value& value : values_) {
    constraints.add_gradient(value.constraint, f * value.acceleration, y);
  }
}

// These are compiled once, beside the steps.
extern template class Drivers<double, 2>;
extern template class Drivers<double, 3>;
extern template class Drivers<float, 2>;
extern template class Drivers<float, 3>;

}  // namespace mbs::compiled_ldl
