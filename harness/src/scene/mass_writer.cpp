// Entries are collected as they come and summed up at the end.
#include "scene/mass_writer.hpp"

#include <algorithm>
#include <utility>

namespace mbs {
namespace {

Matrix3 isotropic(double mass) { return {{{mass, 0, 0}, {0, mass, 0}, {0, 0, mass}}}; }

}  // namespace

MassWriter::MassWriter(ModelData& data) : data_(data), driven_(data.points.size(), false) {
  const auto free_points = std::count_if(data.points.begin(), data.points.end(),
                                         [](const Point& point) { return !point.is_fixed(); });
  const int variables = data.dimension * static_cast<int>(free_points);
  for (int i = 0; i < variables; ++i) entries_.push_back({i, i, 0.0});
  data.force.assign(static_cast<std::size_t>(variables), 0.0);
  for (const DrivenPoint& driven : data.driven_points) {
    driven_[static_cast<std::size_t>(driven.point)] = true;
  }
}

void MassWriter::add_entry(int row, int col, double value) {
  if (value != 0.0) entries_.push_back({std::max(row, col), std::min(row, col), value});
}

void MassWriter::add(int a, int b, const Matrix3& B) {
  const Point& first = data_.points[static_cast<std::size_t>(a)];
  const Point& second = data_.points[static_cast<std::size_t>(b)];
  for (int row = 0; row < data_.dimension; ++row) {
    for (int col = 0; col < (a == b ? row + 1 : data_.dimension); ++col) {
      const double value = B[static_cast<std::size_t>(row)][static_cast<std::size_t>(col)];
      if (!first.is_fixed() && !second.is_fixed()) {
        add_entry(first.offset + row, second.offset + col, value);
      } else if (value != 0.0 && !first.is_fixed() && is_driven(b)) {
        data_.driven_mass.push_back({first.offset + row, b, col, value});
      } else if (value != 0.0 && !second.is_fixed() && is_driven(a)) {
        data_.driven_mass.push_back({second.offset + col, a, row, value});
      } else if (value != 0.0 && is_driven(a) && is_driven(b)) {
        const double share = a == b && row == col ? 0.5 : 1.0;  // others stand for two entries
        driven_energy_.masses.push_back({a, row, b, col, share * value});
      }
    }
  }
}

void MassWriter::push(int point, const Vector3& force) {
  const Point& at = data_.points[static_cast<std::size_t>(point)];
  if (is_driven(point)) driven_energy_.forces.push_back({point, force});
  if (at.is_fixed()) return;
  for (int axis = 0; axis < data_.dimension; ++axis) {
    data_.force[static_cast<std::size_t>(at.offset + axis)] +=
        force[static_cast<std::size_t>(axis)];
  }
}

void MassWriter::add_point_mass(int point, double mass, const Vector3& gravity) {
  add(point, point, isotropic(mass));
  push(point, mass * gravity);
}

void MassWriter::add_rod(Rod rod, const Vector3& gravity) {
  for (const int end : {rod.a, rod.b}) {
    add(end, end, isotropic(rod.mass / 3.0));
    push(end, (rod.mass / 2.0) * gravity);
  }
  add(rod.a, rod.b, isotropic(rod.mass / 6.0));
  data_.dot_constraints.push_back(
      {rod.a, rod.b, rod.a, rod.b, rod.squared_length, std::move(rod.name)});
}

void MassWriter::finish() {
  std::stable_sort(entries_.begin(), entries_.end(), [](const MassEntry& x, const MassEntry& y) {
    return x.col != y.col ? x.col < y.col : x.row < y.row;
  });
  for (const MassEntry& entry : entries_) {
    std::vector<MassEntry>& mass = data_.mass;
    if (!mass.empty() && mass.back().row == entry.row && mass.back().col == entry.col) {
      mass.back().value += entry.value;
    } else {
      mass.push_back(entry);
    }
  }
}

}  // namespace mbs
