// Forces of springs, laws and couples, Eqs. (11) and (18), and products with their C and K.
#pragma once

#include <array>
#include <vector>

#include "force_pattern.hpp"
#include "point_vector.hpp"

namespace mbs::csc_klu {

/// The elements of a ForcePattern, which has to outlive this, at one instant. An element's share of
/// the tangent matrix is dt/2 C + dt^2/4 K = along g g^T + across S S^T, where S has the identity
/// times the sign of the end for each end of a line and is absent from elements about an axis;
/// neither C nor K is stored.
template <int dim>
class Forces {
 public:
  Forces(const ForcePattern& pattern, double step);

  /// Takes the factors of laws at time t, s; those at 0 before.
  void set_time(double t);
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
  /// The force of an element and what T needs of it: its derivatives by s and s', and p of
  /// Eq. (11).
  struct Response {
    double force, stiffness, damping, p;
  };
  /// The next element and its first end.
  struct Place {
    int element = 0, end = 0;
  };
  /// An element along a line; respond(L, L', 1/L) is its Response, 1/L zero where L is.
  template <class Line, class Respond>
  void evaluate_line(const Line& line, const double* q, const double* v, Respond respond,
                     Place& place, double* right);
  /// An element about an axis; respond(theta, theta') is its Response.
  template <class Corner, class Respond>
  void evaluate_corner(const Corner& corner, const double* q, const double* v, Respond respond,
                       Place& place, double* right);
  /// Eq. (18) of a law.
  [[nodiscard]] static Response respond(const Law& law, double factor, double s, double rate,
                                        double inverse);
  /// Writes the gradient of the ends from `end` to `ends_end` and subtracts dt^2/4 force g from
  /// `right`; returns `ends_end`. `by_u` and `by_w` are derivatives as in MovedPoint.
  int apply(int end, int ends_end, const Vector<dim>& by_u, const Vector<dim>& by_w, double force,
            double* right);

  const ForcePattern& pattern_;
  const std::vector<int> stiff_ends_;
  const double damping_weight_, weight_;  ///< dt/2 (s), dt^2/4 (s^2)
  std::vector<double> gradient_;          ///< dim values an end
  std::vector<double> along_, across_;    ///< one an element
  std::vector<double> factors_;           ///< of line_laws, then of axis_laws
};

}  // namespace mbs::csc_klu
