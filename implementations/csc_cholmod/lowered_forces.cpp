// Records places and entries of every force element.
#include "lowered_forces.hpp"

namespace mbs::csc_cholmod {
namespace {

/// Pushes the entries of `point`, if it is free: plus or minus the values from `first` on.
void push_point(const Coordinates& coordinates, int point, int first, bool negative,
                SignedRows& rows) {
  if (!coordinates.is_unknown(coordinates.place(point, 0))) return;
  for (int axis = 0; axis < coordinates.dimension(); ++axis) {
    rows.push({coordinates.place(point, axis), first + axis, negative});
  }
}

}  // namespace

LoweredForces::LoweredForces(const Model& model, const Coordinates& coordinates) {
  springs.dimension = model.dimension();
  add_springs(model, coordinates);
  add_torsions(model, coordinates);
  add_couples(model, coordinates);
}

void LoweredForces::add_springs(const Model& model, const Coordinates& coordinates) {
  SpringBlock& s = springs;
  const int count = s.count = static_cast<int>(model.springs().size() + model.force_laws().size());
  for (auto* places : {&s.plus, &s.minus}) places->resize(spring_values());
  int k = 0;
  const auto add = [&](int a, int b) {
    for (int axis = 0; axis < s.dimension; ++axis) {
      const int value = axis * count + k;
      const int plus = s.plus[value] = coordinates.place(a, axis);
      const int minus = s.minus[value] = coordinates.place(b, axis);
      if (coordinates.is_unknown(plus)) gradients_.push({plus, value, false});
      if (coordinates.is_unknown(minus)) gradients_.push({minus, value, true});
    }
    gradients_.end_row();
    ++k;
  };
  for (const Spring& spring : model.springs()) {
    add(spring.a, spring.b);
    s.stiffness.push_back(spring.stiffness);
    s.damping.push_back(spring.damping);
    s.length.push_back(spring.length);
  }
  for (const ForceLaw& f : model.force_laws()) {
    add(f.a, f.b);
    laws.push_back(&f.law);
  }
}

void LoweredForces::add_torsions(const Model& model, const Coordinates& coordinates) {
  const auto add = [&](const auto& t) -> TorsionElement& {
    const int u = gradient_values();
    const int w = u + model.dimension();
    push_point(coordinates, t.a, u, true, gradients_);
    push_point(coordinates, t.b, u, false, gradients_);
    push_point(coordinates, t.c, w, false, gradients_);
    push_point(coordinates, t.d, w, true, gradients_);
    gradients_.end_row();
    const auto at = [&](int point) { return coordinates.places(point); };
    return torsions.emplace_back(
        TorsionElement{at(t.a), at(t.b), at(t.c), at(t.d), coordinates.axis_places(t.axis)});
  };
  for (const TorsionSpring& t : model.torsion_springs()) {
    TorsionElement& element = add(t);
    element.stiffness = t.stiffness;
    element.damping = t.damping;
    element.angle = t.angle;
  }
  for (const TorqueLaw& t : model.torque_laws()) {
    add(t).law = static_cast<int>(laws.size());
    laws.push_back(&t.law);
  }
}

void LoweredForces::add_couples(const Model& model, const Coordinates& coordinates) {
  for (const Couple& c : model.couples()) {
    const int first = values();
    push_point(coordinates, c.a, first, false, couple_rows_);
    push_point(coordinates, c.b, first, true, couple_rows_);
    couple_rows_.end_row();
    couples.push_back({coordinates.places(c.a), coordinates.places(c.b),
                       coordinates.axis_places(c.axis), c.torque});
  }
}

int LoweredForces::products() const {
  return spring_products() +
         product_count(2 * springs.dimension) * static_cast<int>(torsions.size());
}

int LoweredForces::product(int row, int i, int j) const {
  const int count = springs.count;
  const int dimension = springs.dimension;
  if (row < count) return product_number(dimension, i / count, j / count) * count + row;
  const int torsion = row - count;
  const int first = spring_values() + 2 * dimension * torsion;
  return spring_products() + product_count(2 * dimension) * torsion +
         product_number(2 * dimension, i - first, j - first);
}

}  // namespace mbs::csc_cholmod
