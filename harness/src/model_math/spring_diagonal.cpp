// Each spring, damper and law adds to the diagonals of the points that it acts on.
#include "model_math/spring_diagonal.hpp"

#include <algorithm>
#include <cstddef>

#include "model_math/vector3.hpp"

namespace mbs {
namespace {

/// A law as a spring, for its period: as stiff as it becomes, as damped as it is at rest. Bump
/// stops are to be resolved although they do not touch at the start.
struct LawAsSpring {
  explicit LawAsSpring(const Law& law) {
    const double factor = law.factor.at(0.0).value;
    stiffness = std::max(0.0, factor * law.by_position.at(0.0).slope);  // straight: no breaks
    for (const double x : law.by_position.breaks) {
      stiffness = std::max(stiffness, factor * law.by_position.at(x).slope);
    }
    damping = std::max(0.0, factor * law.by_rate.at(0.0).slope);
  }
  double stiffness = 0.0, damping = 0.0;
};

class Sum {
 public:
  SpringDiagonal diagonal;

  explicit Sum(const Model& model) : model_(model) {
    diagonal.stiffness.resize(static_cast<std::size_t>(model.variables()));
    diagonal.damping = diagonal.stiffness;
    for (const Spring& spring : model.springs()) add_spring(spring);
    for (const TorsionSpring& spring : model.torsion_springs()) add_torsion_spring(spring);
    for (const ForceLaw& law : model.force_laws()) {
      const LawAsSpring as(law.law);
      // Slack at the start: what a force holds across the line is left out.
      const double length = norm(point(law.a).position - point(law.b).position);
      add_spring({law.a, law.b, as.stiffness, as.damping, length, ""});
    }
    for (const TorqueLaw& law : model.torque_laws()) {
      const LawAsSpring as(law.law);
      add_torsion_spring({law.a, law.b, law.c, law.d, law.axis, as.stiffness, as.damping, 0.0, ""});
    }
  }

 private:
  [[nodiscard]] const Point& point(int index) const {
    return model_.points()[static_cast<std::size_t>(index)];
  }
  void add(int index, const Vector3& k, const Vector3& c) {
    if (point(index).is_fixed()) return;
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      const auto i = static_cast<std::size_t>(point(index).offset + axis);
      diagonal.stiffness[i] += k[static_cast<std::size_t>(axis)];
      diagonal.damping[i] += c[static_cast<std::size_t>(axis)];
    }
  }
  void add_spring(const Spring& spring) {
    const Vector3 d = point(spring.a).position - point(spring.b).position;
    const double length = norm(d);
    const Vector3 e = (length > 0.0 ? 1.0 / length : 0.0) * d;
    const double across =
        length > 0.0 ? std::max(0.0, spring.stiffness * (1.0 - spring.length / length)) : 0.0;
    Vector3 k{}, c{};
    for (std::size_t i = 0; i < 3; ++i) {
      k[i] = spring.stiffness * e[i] * e[i] + across * (1.0 - e[i] * e[i]);
      c[i] = spring.damping * e[i] * e[i];
    }
    add(spring.a, k, c);
    add(spring.b, k, c);
  }
  void add_torsion_spring(const TorsionSpring& spring) {
    add_turning(spring, spring.a, spring.b);
    add_turning(spring, spring.c, spring.d);
  }
  void add_turning(const TorsionSpring& spring, int a, int b) {
    const Vector3 w = point(a).position - point(b).position;
    const Vector3 z =
        spring.axis < 0 ? Vector3{0.0, 0.0, 1.0} : Vector3(point(spring.axis).position);
    const Vector3 g = (1.0 / dot(w, w)) * cross(z, w);
    Vector3 k{}, c{};
    for (std::size_t i = 0; i < 3; ++i) {
      k[i] = spring.stiffness * g[i] * g[i];
      c[i] = spring.damping * g[i] * g[i];
    }
    add(a, k, c);
    add(b, k, c);
  }

  const Model& model_;
};

}  // namespace

SpringDiagonal spring_diagonal(const Model& model) { return Sum(model).diagonal; }

}  // namespace mbs
