// Springs, dampers and couples: Eq. (11), its share of T in coordinate format.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::starting_sparse {

/// Elements carry what (Delta t / 2) C + (Delta t^2 / 4) K is made of; the matrices themselves are
/// entries at the end of T's list. Coordinates q and velocities v come extended, see Assembly.
class Forces {
 public:
  /// `point_offset`: of each point in an extended vector. `step` is Delta t (s).
  Forces(const Model& model, std::span<const int> point_offset, double step);

  /// Appends the positions (1-based, lower triangle) of this share of T, duplicates among them.
  void append_positions(std::vector<int>& rows, std::vector<int>& columns) const;

  /// Evaluates all elements at q and v, and right (n) += (Delta t^2 / 4) their part of Q.
  void add_forces(const double* q, const double* v, double* right);
  /// False if a number of the last evaluation was infinite or undefined.
  [[nodiscard]] bool is_finite() const;
  /// Writes the last evaluation's share of T in the order of append_positions().
  void assemble(double* entries) const;

 private:
  using Vector = std::array<double, 3>;

  /// The free ones among two points: columns of q, ascending, and 1 for the first point, -1 for
  /// the second.
  struct Ends {
    int count = 0;
    std::array<int, 2> column{};
    std::array<double, 2> sign{};
  };
  struct SpringElement {
    int a, b;
    Ends ends;
    double stiffness, damping, length;
    Vector direction{};                // e
    double along = 0.0, across = 0.0;  // of e e' and I - e e' in T, kg
  };
  struct TorsionElement {
    std::array<int, 4> point;
    int axis;  // of z in an extended vector; planar: 0, unused
    double stiffness, damping, angle;
    int count = 0;                // of distinct free points
    std::array<int, 4> column{};  // theirs, ascending
    std::array<int, 4> slot{};    // of each of `point` in the next; 4 if it is fixed
    std::array<Vector, 5> gradient{};
    double weight = 0.0;  // of g g' in T, kg m^2
  };
  struct CoupleElement {
    int a, b, axis;
    Ends ends;
    double torque;
  };

  /// Calls visit(s, i, r, j) for the lower triangle of an element with `count` free points: axis i
  /// of point s against axis j of point r.
  template <class Visit>
  void for_each_entry(int count, const Visit& visit) const {
    for (int s = 0; s < count; ++s) {
      for (int r = 0; r <= s; ++r) {
        for (int i = 0; i < dimension_; ++i) {
          const int end = r == s ? i + 1 : dimension_;
          for (int j = 0; j < end; ++j) visit(s, i, r, j);
        }
      }
    }
  }

  [[nodiscard]] Ends free_ends(int a, int b) const;
  void append_torsion(const TorsionSpring& spring, std::span<const int> point_offset);

  template <int kDimension>
  void evaluate_springs(const double* q, const double* v, double* right);
  template <int kDimension>
  void evaluate_torsions(const double* q, const double* v, double* right);
  template <int kDimension>
  void evaluate_couples(const double* q, double* right);

  int variables_ = 0, dimension_ = 0;
  double half_step_ = 0.0, weight_ = 0.0;  // Delta t / 2 and Delta t^2 / 4
  std::vector<SpringElement> springs_;
  std::vector<TorsionElement> torsions_;
  std::vector<CoupleElement> couples_;
  double magnitude_ = 0.0;  // of the forces; infinite or undefined if one of them is
};

}  // namespace mbs::starting_sparse
