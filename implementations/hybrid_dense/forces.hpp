// Springs, laws and couples: their forces, Eq. (11) and (18), and what they put into T_0.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "schedule.hpp"
#include "slots.hpp"

namespace mbs::hybrid_dense {

/// D is the dimension. "Lines" are springs and laws between two points, "angles" torsion springs
/// and laws about an axis.
template <int D>
class Forces {
 public:
  Forces(const Model& model, const Slots& slots, double dt);

  [[nodiscard]] bool any() const {
    return !lines_.empty() || !angles_.empty() || !couples_.empty();
  }
  /// Whether T_0 changes with the motion.
  [[nodiscard]] bool in_tangent() const { return !lines_.empty() || !angles_.empty(); }

  /// Factors of laws, at time t.
  void drive(double t);
  /// f -= Q of these; also what add_tangent() is of.
  void evaluate(const double* q, const double* v, double* f);

  /// (row, column), row >= column, of what add_tangent() adds to.
  [[nodiscard]] std::vector<std::pair<int, int>> tangent_entries() const;
  /// Where these are.
  void schedule(const Schedule::Position& position);
  /// T += (dt/2) C + (dt^2/4) K.
  void add_tangent(double* T) const;

 private:
  struct Line {
    int a, b;
    double stiffness, damping, length;
    const Law* law;  // nullptr: a spring
    double factor;
  };
  struct Angle {
    int a, b, c, d, axis;
    double stiffness, damping, angle;
    const Law* law;
    double factor;
  };
  struct Couple {
    int a, b, axis;
    double torque;
  };
  struct Block {
    double values[D * D];  // at (a, a) and (b, b); its negative at (a, b) and (b, a)
  };
  struct Gradient {
    double weight, g[4 * D];  // at a, b, c, d
  };
  struct Addition {
    long position;
    int value;  // into the blocks
  };
  struct Product {
    long position;
    int angle, left, right;
  };
  template <class Visit>
  void visit_lines(Visit visit) const;  // visit(row, column, value, negative)
  template <class Visit>
  void visit_angles(Visit visit) const;  // visit(row, column, angle, left, right)

  const long n_;
  const double dt_;
  std::vector<Line> lines_;
  std::vector<Angle> angles_;
  std::vector<Couple> couples_;
  std::vector<Block> blocks_;        // of lines
  std::vector<Gradient> gradients_;  // of angles
  std::vector<Addition> additions_, subtractions_;
  std::vector<Product> products_;
};

}  // namespace mbs::hybrid_dense
