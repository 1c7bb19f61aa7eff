// Forces of springs, torsion springs and couples, Eq. (11), and products with their C and K.
#pragma once

#include <array>
#include <vector>

#include "force_pattern.hpp"
#include "point_vector.hpp"

namespace mbs::csc_klu {

/// The elements of a ForcePattern, which has to outlive this, at one instant. An element's share of
/// the tangent matrix is dt/2 C + dt^2/4 K = along g g^T + across S S^T, where S has the identity
/// times the sign of a spring's end for each end and is absent from torsion springs; neither C
/// nor K is stored.
template <int dim>
class Forces {
 public:
  Forces(const ForcePattern& pattern, double step);

  /// Evaluates all elements at the extended positions q and velocities v, and adds their share of
  /// dt^2/4 Q to `right` (n).
  void evaluate(const double* q, const double* v, double* right);
  /// Takes C and K over from another one on the same pattern.
  void copy_stiffness(const Forces& other);
  /// y (n) += (dt/2 C + dt^2/4 K) x with what evaluate() found; x is n.
  void add_product(const double* x, double* y) const;

  [[nodiscard]] bool any() const { return !pattern_.ends.empty(); }
  [[nodiscard]] const double* gradient(int end) const { return gradient_.data() + dim * end; }
  [[nodiscard]] double along(int element) const { return along_[element]; }
  [[nodiscard]] double across(int element) const { return across_[element]; }

 private:
  void evaluate_springs(const double* q, const double* v, double* right);
  void evaluate_torsions(const double* q, const double* v, double* right);
  void evaluate_couples(const double* q, double* right);
  /// Writes the gradient of the ends from `end` to `ends_end` and subtracts dt^2/4 force g from
  /// `right`; returns `ends_end`. `by_u` and `by_w` are derivatives as in MovedPoint.
  int apply(int end, int ends_end, const Vector<dim>& by_u, const Vector<dim>& by_w, double force,
            double* right);

  const ForcePattern& pattern_;
  const std::vector<int> stiff_ends_;
  const double damping_weight_, weight_;  ///< dt/2 (s), dt^2/4 (s^2)
  std::vector<double> gradient_;          ///< dim values an end
  std::vector<double> along_, across_;    ///< one an element
};

}  // namespace mbs::csc_klu
