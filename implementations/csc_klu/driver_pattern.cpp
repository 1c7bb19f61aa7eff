// Where driven points and values enter the equations, found once from the model.
#include "driver_pattern.hpp"

#include "extended_points.hpp"

namespace mbs::csc_klu {

template <int dim>
DriverPattern<dim>::DriverPattern(const Model& model, const JacobianPattern<dim>& jacobian) {
  if (model.driven_points().empty() && model.driven_values().empty()) return;
  const std::vector<int> offset = extended_offsets(model);
  for (const DrivenPoint& driven : model.driven_points()) {
    points.push_back({offset[driven.point], &driven.position});
  }
  std::vector<int> row_of(model.constraints());
  for (int i = 0; i < model.constraints(); ++i) row_of[jacobian.model_row[i]] = i;
  for (const DrivenValue& driven : model.driven_values()) {
    values.push_back({row_of[driven.constraint], &driven.value});
  }
  for (const DrivenMass& mass : model.driven_mass()) {
    masses.push_back({mass.coordinate, offset[mass.point] + mass.axis, mass.value});
  }
}

template struct DriverPattern<2>;
template struct DriverPattern<3>;

}  // namespace mbs::csc_klu
