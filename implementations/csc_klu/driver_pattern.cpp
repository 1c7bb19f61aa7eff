// Where driven points and values enter the equations, found once from the model.
#include "driver_pattern.hpp"

#include "extended_points.hpp"
#include "quadratic_form.hpp"

namespace mbs::csc_klu {
template <int dim>
DriverPattern<dim>::DriverPattern(const Model& model, const JacobianPattern<dim>& jacobian) {
  if (model.driven_points().empty() && model.driven_values().empty()) return;
  const std::vector<int> offset = extended_offsets(model);
  std::vector<int> moved(offset.size(), 0);
  for (const DrivenPoint& driven : model.driven_points()) {
    points.push_back({offset[driven.point], &driven.position});
    moved[driven.point] = dim * static_cast<int>(points.size());
  }
  std::vector<int> row_of(model.constraints()), value_of_row(model.constraints(), 0);
  for (int i = 0; i < model.constraints(); ++i) row_of[jacobian.model_row[i]] = i;
  for (const DrivenValue& driven : model.driven_values()) {
    const int row = row_of[driven.constraint];
    values.push_back({row, &driven.value});
    value_of_row[row] = static_cast<int>(values.size());
  }
  for (const DrivenMass& mass : model.driven_mass()) {
    masses.push_back({mass.coordinate, moved[mass.point] + mass.axis, mass.value});
  }
  find_rows(model, jacobian, moved, value_of_row);
}

template <int dim>
void DriverPattern<dim>::find_rows(const Model& model, const JacobianPattern<dim>& jacobian,
                                   const std::vector<int>& moved,
                                   const std::vector<int>& value_of_row) {
  const std::vector<int> offset = extended_offsets(model);
  std::vector<int> index(jacobian.quadratics(), -1);
  for (int i = 0; i < jacobian.quadratics(); ++i) {
    const QuadraticForm<dim> form = quadratic_form<dim>(model, jacobian.model_row[i]);
    Row row{{}, {}, value_of_row[i], form.B};
    for (int k = 0; k < 4; ++k) {
      row.at[k] = offset[form.abcd[k]];
      row.moved[k] = moved[form.abcd[k]];
    }
    if (row.value == 0 && row.moved == std::array<int, 4>{}) continue;
    index[i] = static_cast<int>(rows.size());
    rows.push_back(row);
  }
  for (int p = 0; p < jacobian.points(); ++p) {
    for (int block = jacobian.block_begin[p]; block < jacobian.block_begin[p + 1]; ++block) {
      const int row = index[jacobian.block_row[block]];
      if (row >= 0) terms.push_back({row, block, dim * p});
    }
  }
  int begin = 0;
  for (int i = 0; i < std::ssize(jacobian.linears); ++i) {
    const int end = jacobian.linears[i].terms_end;
    const int value = value_of_row[jacobian.quadratics() + i];
    if (value > 0) linears.push_back({begin, end, value});
    begin = end;
  }
}

template struct DriverPattern<2>;
template struct DriverPattern<3>;

}  // namespace mbs::csc_klu
