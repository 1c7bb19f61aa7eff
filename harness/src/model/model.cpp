// Checks and normalises the data of a model.
#include "mbs/model.hpp"

#include <algorithm>
#include <cmath>
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
    for (int axis = 0; axis < data.dimension; ++axis) {
      require_finite(point.position[static_cast<std::size_t>(axis)], "point '" + point.name + "'");
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

void check_constraints(const ModelData& data, int variables) {
  const int points = static_cast<int>(data.points.size());
  for (const DotConstraint& constraint : data.dot_constraints) {
    for (const int index : {constraint.a, constraint.b, constraint.c, constraint.d}) {
      if (index < 0 || index >= points) {
        fail("constraint '" + constraint.name + "' refers to point " + std::to_string(index));
      }
    }
    require_finite(constraint.value, "constraint '" + constraint.name + "'");
  }
  for (const LinearConstraint& constraint : data.linear_constraints) {
    std::vector<int> coordinates;
    for (const LinearConstraint::Term& term : constraint.terms) {
      if (term.coordinate < 0 || term.coordinate >= variables) {
        fail("constraint '" + constraint.name + "' refers to coordinate " +
             std::to_string(term.coordinate));
      }
      require_finite(term.coefficient, "constraint '" + constraint.name + "'");
      coordinates.push_back(term.coordinate);
    }
    std::sort(coordinates.begin(), coordinates.end());
    if (std::adjacent_find(coordinates.begin(), coordinates.end()) != coordinates.end()) {
      fail("constraint '" + constraint.name + "' names a coordinate twice");
    }
    require_finite(constraint.value, "constraint '" + constraint.name + "'");
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
  check_constraints(data_, variables_);
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
