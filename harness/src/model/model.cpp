// Checks and normalises the data of a model.
#include "mbs/model.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace mbs {
namespace {

[[noreturn]] void fail(const std::string& what) { throw std::invalid_argument("model: " + what); }

void require_finite(double value, const std::string& what) {
  if (!std::isfinite(value)) fail(what + " is not finite");
}

/// Free points must tile q: returns n.
int count_variables(const ModelData& data) {
  std::vector<int> offsets;
  for (const Point& point : data.points) {
    const std::string what = "point '" + point.name + "'";
    for (int axis = 0; axis < data.dimension; ++axis) {
      require_finite(point.position[static_cast<std::size_t>(axis)], what);
    }
    if (!point.is_fixed()) offsets.push_back(point.offset);
  }
  std::sort(offsets.begin(), offsets.end());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    if (offsets[i] != static_cast<int>(i) * data.dimension) {
      fail("the free points' offsets do not tile q: offset " + std::to_string(offsets[i]));
    }
  }
  return static_cast<int>(offsets.size()) * data.dimension;
}

/// Refuses what refers to anything that is not there.
class IndexCheck {
 public:
  explicit IndexCheck(const ModelData& data) : data_(data) {}

  void points(std::initializer_list<int> indices, const std::string& what) const {
    for (const int index : indices) {
      if (index < 0 || index >= static_cast<int>(data_.points.size())) {
        fail(what + " refers to point " + std::to_string(index));
      }
    }
  }
  /// Of a torsion spring or couple: a point in three dimensions, none in the plane.
  void axis(int index, const std::string& what) const {
    if (data_.dimension == 3) return points({index}, what);
    if (index != -1) fail(what + " has an axis in a planar model");
  }
  void different(int a, int b, const std::string& what) const {
    if (a == b) fail(what + " has the same point at both ends");
  }
  /// The ends of a spring or force law.
  template <class Line>
  void line(const Line& one, const std::string& what) const {
    points({one.a, one.b}, what);
    different(one.a, one.b, what);
  }
  /// The two directions and the axis of a torsion spring or torque law.
  template <class Corner>
  void corner(const Corner& one, const std::string& what) const {
    points({one.a, one.b, one.c, one.d}, what);
    axis(one.axis, what);
    different(one.a, one.b, what);
    different(one.c, one.d, what);
  }

 private:
  const ModelData& data_;
};

void check_quadratic(const ModelData& data) {
  const IndexCheck check(data);
  for (const DotConstraint& c : data.dot_constraints) {
    const std::string what = "constraint '" + c.name + "'";
    check.points({c.a, c.b, c.c, c.d}, what);
    require_finite(c.value, what);
  }
  for (const BilinearConstraint& c : data.bilinear_constraints) {
    const std::string what = "constraint '" + c.name + "'";
    check.points({c.a, c.b, c.c, c.d}, what);
    require_finite(c.value, what);
    for (const auto& row : c.B) {
      for (const double entry : row) require_finite(entry, what);
    }
  }
}

void require_not_negative(double value, const std::string& what) {
  require_finite(value, what);
  if (value < 0.0) fail(what + " is negative");
}

void check_curve(const Curve& curve, const std::string& what) {
  if (curve.pieces.size() != curve.breaks.size() + 1)
    fail(what + " has not one piece more than breaks");
  for (const double x : curve.breaks) require_finite(x, what);
  const auto falls = std::ranges::adjacent_find(curve.breaks, std::ranges::greater_equal{});
  if (falls != curve.breaks.end()) fail(what + " has breaks that do not increase");
  for (const Curve::Piece& piece : curve.pieces) {
    require_finite(piece.origin, what);
    for (const double c : piece.coefficients) require_finite(c, what);
  }
}

void check_law(const Law& law, const std::string& what) {
  check_curve(law.by_position, what);
  check_curve(law.by_rate, what);
  require_finite(law.factor.at(0.0).value, what);
}

void check_laws(const ModelData& data) {
  const IndexCheck check(data);
  for (const ForceLaw& law : data.force_laws) {
    const std::string what = "force law '" + law.name + "'";
    check.line(law, what);
    check_law(law.law, what);
  }
  for (const TorqueLaw& law : data.torque_laws) {
    const std::string what = "torque law '" + law.name + "'";
    check.corner(law, what);
    check_law(law.law, what);
  }
}

void check_forces(const ModelData& data) {
  const IndexCheck check(data);
  for (const Spring& spring : data.springs) {
    const std::string what = "spring '" + spring.name + "'";
    check.line(spring, what);
    for (const double value : {spring.stiffness, spring.damping, spring.length}) {
      require_not_negative(value, what);
    }
  }
  for (const TorsionSpring& spring : data.torsion_springs) {
    const std::string what = "torsion spring '" + spring.name + "'";
    check.corner(spring, what);
    for (const double value : {spring.stiffness, spring.damping}) require_not_negative(value, what);
    require_finite(spring.angle, what);
  }
  for (const Couple& couple : data.couples) {
    const std::string what = "couple '" + couple.name + "'";
    check.points({couple.a, couple.b}, what);
    check.axis(couple.axis, what);
    check.different(couple.a, couple.b, what);
    require_finite(couple.torque, what);
  }
}

void check_drivers(const ModelData& data, int variables) {
  const IndexCheck check(data);
  std::vector<bool> driven(data.points.size(), false);
  for (const DrivenPoint& point : data.driven_points) {
    check.points({point.point}, "a driven point");
    const auto index = static_cast<std::size_t>(point.point);
    if (!data.points[index].is_fixed())
      fail("point '" + data.points[index].name + "' is driven and free");
    if (driven[index]) fail("point '" + data.points[index].name + "' is driven twice");
    driven[index] = true;
  }
  const std::size_t constraints = data.dot_constraints.size() + data.bilinear_constraints.size() +
                                  data.linear_constraints.size();
  std::vector<bool> valued(constraints, false);
  for (const DrivenValue& value : data.driven_values) {
    const auto index = static_cast<std::size_t>(value.constraint);
    if (value.constraint < 0 || index >= constraints) {
      fail("a driven value refers to constraint " + std::to_string(value.constraint));
    }
    if (valued[index]) fail("constraint " + std::to_string(value.constraint) + " is driven twice");
    valued[index] = true;
  }
  for (const DrivenMass& mass : data.driven_mass) {
    check.points({mass.point}, "a driven mass");
    if (!driven[static_cast<std::size_t>(mass.point)] || mass.coordinate < 0 ||
        mass.coordinate >= variables || mass.axis < 0 || mass.axis >= data.dimension) {
      fail("a driven mass does not fit: coordinate " + std::to_string(mass.coordinate) +
           ", point " + std::to_string(mass.point) + ", axis " + std::to_string(mass.axis));
    }
    require_finite(mass.value, "a driven mass");
  }
}

void check_linear(const ModelData& data, int variables) {
  std::vector<int> coordinates;
  for (const LinearConstraint& constraint : data.linear_constraints) {
    const std::string what = "constraint '" + constraint.name + "'";
    coordinates.clear();
    for (const LinearConstraint::Term& term : constraint.terms) {
      if (term.coordinate < 0 || term.coordinate >= variables) {
        fail(what + " refers to coordinate " + std::to_string(term.coordinate));
      }
      require_finite(term.coefficient, what);
      coordinates.push_back(term.coordinate);
    }
    std::sort(coordinates.begin(), coordinates.end());
    if (std::adjacent_find(coordinates.begin(), coordinates.end()) != coordinates.end()) {
      fail(what + " names a coordinate twice");
    }
    require_finite(constraint.value, what);
  }
}

void normalise_mass(std::vector<MassEntry>& mass, int variables) {
  for (const MassEntry& entry : mass) {
    if (entry.col < 0 || entry.row < entry.col || entry.row >= variables) {
      fail("mass entry (" + std::to_string(entry.row) + ", " + std::to_string(entry.col) +
           ") is outside the lower triangle");
    }
    require_finite(entry.value, "a mass entry");
  }
  const auto before = [](const MassEntry& x, const MassEntry& y) {
    return x.col != y.col ? x.col < y.col : x.row < y.row;
  };
  std::sort(mass.begin(), mass.end(), before);
  int diagonals = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (i > 0 && !before(mass[i - 1], mass[i])) {
      fail("mass entry (" + std::to_string(mass[i].row) + ", " + std::to_string(mass[i].col) +
           ") is given twice");
    }
    if (mass[i].row == mass[i].col) {
      if (!(mass[i].value > 0.0)) {
        fail("coordinate " + std::to_string(mass[i].row) + " has no mass");
      }
      ++diagonals;
    }
  }
  if (diagonals != variables) fail("a coordinate has no mass");
}

}  // namespace

Model::Model(ModelData data) : data_(std::move(data)) {
  if (data_.dimension != 2 && data_.dimension != 3) fail("the dimension must be 2 or 3");
  variables_ = count_variables(data_);
  check_quadratic(data_);
  check_linear(data_, variables_);
  check_forces(data_);
  check_laws(data_);
  check_drivers(data_, variables_);
  normalise_mass(data_.mass, variables_);
  const auto n = static_cast<std::size_t>(variables_);
  if (data_.force.size() != n) fail("the applied force must have one entry a coordinate");
  if (data_.initial_velocity.size() != n) fail("the velocity must have one entry a coordinate");
  for (const double value : data_.force) require_finite(value, "the applied force");
  for (const double value : data_.initial_velocity) require_finite(value, "the velocity");
  initial_position_.resize(n);
  for (const Point& point : data_.points) {
    if (point.is_fixed()) continue;
    std::copy_n(point.position.begin(), data_.dimension, initial_position_.begin() + point.offset);
  }
}

}  // namespace mbs
