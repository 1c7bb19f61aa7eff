// The second derivatives of Phi, which are constants: found once from the model.
#include "hessians.hpp"

#include "extended_points.hpp"
#include "quadratic_form.hpp"

namespace mbs::csc_klu {

template <int dim>
std::vector<HessianEntry> hessian_entries(const Model& model,
                                          const JacobianPattern<dim>& jacobian) {
  std::vector<HessianEntry> entries;
  std::vector<MovedPoint> moved;
  for (int i = 0; i < jacobian.quadratics(); ++i) {
    const QuadraticForm<dim> form = quadratic_form<dim>(model, jacobian.model_row[i]);
    const auto& B = form.B;
    moved.clear();
    append_moved_points(model, {form.abcd[0], form.abcd[1], form.abcd[2], form.abcd[3]}, moved);
    for (const MovedPoint& x : moved) {
      for (const MovedPoint& y : moved) {
        for (int row = 0; row < dim; ++row) {
          for (int col = 0; col < dim; ++col) {
            const double value =
                x.first * y.second * B[row][col] + x.second * y.first * B[col][row];  // Eq. (16)
            if (value == 0.0) continue;
            entries.push_back({i, x.coordinate + row, y.coordinate + col, value});
          }
        }
      }
    }
  }
  return entries;
}

template std::vector<HessianEntry> hessian_entries(const Model&, const JacobianPattern<2>&);
template std::vector<HessianEntry> hessian_entries(const Model&, const JacobianPattern<3>&);

}  // namespace mbs::csc_klu
