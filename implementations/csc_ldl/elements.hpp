// Springs, laws and couples: Eqs. (11) and (18).
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "group.hpp"
#include "mbs/model.hpp"

namespace mbs::csc_ldl {

/// Forces and their part (dt/2) C + (dt^2/4) K of T_0.
class Elements {
 public:
  Elements(const Model& model, const Coordinates& at, double step);

  [[nodiscard]] bool empty() const { return force_parts_ == 0; }

  // For setup: what an entry sums up, among the parts that the functions below write.
  void visit_forces(const std::function<void(int i, int part)>& visit) const;
  void visit_products(const std::function<void(int i, int j, int part)>& visit) const;
  [[nodiscard]] int force_parts() const { return force_parts_; }
  [[nodiscard]] int matrix_parts() const {
    return lines_.group.matrix_parts() + angles_.group.matrix_parts();
  }

  /// The laws' factors at time t.
  void drive(double t);
  /// Parts of -Q and of T_0; v are velocities of all points.
  void evaluate(const double* q, const double* v, double* force_parts, double* matrix_parts);

 private:
  struct Spring {
    double stiffness, damping, free;  // free: s_0
  };
  /// Elements with one s(q): springs first, then laws. Vectors are by element.
  struct Family {
    Group group;  // its gradient is that of s
    std::vector<Spring> springs;
    std::vector<const Law*> laws;
    std::vector<double> law_factor;
    std::vector<double> s, rate, force, slope;  // slope: the factor of g g^T in T_0

    void resize();
    void drive(double t);
  };

  template <int dimension>
  void evaluate_geometry(const double* q);
  void evaluate_forces(Family& family, bool along_lines);

  double dt_2_, dt2_4_;  // dt/2, dt^2/4
  Family lines_, angles_;
  std::vector<double> geometric_;  // (dt^2/4) p of lines
  Group couples_;                  // the gradient is the opposite of the force
  std::vector<double> torque_;
  std::vector<std::array<int, 3>> angle_axis_, couple_axis_;  // 3D: places of z
  int force_parts_ = 0;
};

}  // namespace mbs::csc_ldl
