// Numbers the points, then lowers rods, bodies, constraints, forces and outputs in this order.
#include "scene/lowering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model_math/extent.hpp"
#include "printable.hpp"
#include "scene/output_columns.hpp"

namespace mbs {

Lowered Lowering::run() {
  model().dimension = draft_.dimension;
  number_points();
  mass_.emplace(model());
  lower_rods();
  lower_masses();
  lower_bodies();
  for (const DraftConstraint& constraint : draft_.constraints) lower_constraint(constraint);
  lower_forces();
  mass_->finish();
  lowered_.data.elements.driven_energy = mass_->driven_energy();
  rows_.finish();
  lower_elements();
  lower_outputs();
  refuse_same_columns();
  lowered_.data.elements.drivers = std::move(draft_.drivers);
  lowered_.data.largest_correction = draft_.largest_correction.value_or(default_correction());
  return std::move(lowered_);
}

void Lowering::number_points() {
  for (DraftPoint& point : draft_.points) {
    const bool is_free = point.hold == Hold::free;
    if (point.bodies.empty() && !point.is_used && !point.is_loaded &&
        !(point.is_output && !is_free)) {
      point.node->fail("an unconnected point or vector",
                       "one that a rod, body, mass, constraint, spring, force or torque names");
    }
    // What remains is computed from its body's basis.
    if (is_free && point.bodies.size() == 1 && !point.is_member) continue;
    add_point(point);
  }
}

void Lowering::add_point(DraftPoint& point) {
  ModelData& data = model();
  point.index = static_cast<int>(data.points.size());
  const bool is_free = point.hold == Hold::free;
  const int offset = is_free ? static_cast<int>(data.initial_velocity.size()) : -1;
  data.points.push_back({point.name, offset, *point.position, point.is_vector});
  lowered_.labels.push_back((point.node ? point.node->path() + ' ' : "") + in_quotes(point.name));
  lowered_.data.velocity_paths.push_back(velocity_path(point));
  if (point.hold == Hold::driven) data.driven_points.push_back({point.index, point.motion});
  if (!is_free) return;
  const Vector3 velocity = point.velocity.value_or(Vector3{});
  data.initial_velocity.insert(data.initial_velocity.end(), velocity.begin(),
                               velocity.begin() + draft_.dimension);
}

/// Where the file gives the velocity: with the point, or by its first body's motion.
std::string Lowering::velocity_path(const DraftPoint& point) const {
  if (!point.velocity) return "";
  return point.is_carried ? draft_.body(point.bodies.front()).node.path()
                          : point.node->path() + ".velocity";
}

void Lowering::lower_rods() {
  for (const DraftRod& rod : draft_.rods) {
    const JsonNode between = rod.node.get("between");
    const Vector3 difference = position(rod.a) - position(rod.b);
    if (!(dot(difference, difference) > 0.0)) {
      between.fail("a rod of length 0 (its points start at the same place)", "a length above 0");
    }
    const double squared = rod.length ? *rod.length * *rod.length : dot(difference, difference);
    if (!(squared > 0.0)) rod.node.get("length").fail("a length in m above 0, as is its square");
    const int a = index(rod.a), b = index(rod.b);
    refuse_same_dot(rod.node, {rod.a, rod.b}, {rod.a, rod.b});
    remember(rod.node,
             {Output::Force::tension, {{Row::Kind::dot, model().dot_constraints.size()}}});
    mass_->add_rod({a, b, rod.mass, squared, rod.name}, draft_.gravity);
    lengths_.emplace(std::minmax(a, b), std::sqrt(squared));
    const auto name = rod.node.find("name");
    lowered_.data.elements.rods.push_back({name ? name->text() : rod.name, a, b});
  }
}

void Lowering::lower_masses() {
  for (const DraftMass& mass : draft_.masses) {
    const DraftPoint& point = draft_.point(mass.point);
    if (point.index >= 0) {
      mass_->add_point_mass(point.index, mass.mass, draft_.gravity);
    } else {  // on a body and nothing else: part of it
      DraftBody& body = draft_.body(point.bodies.front());
      body.inertia =
          with_point_mass(body.inertia, body.items[point.item].local, mass.mass, draft_.dimension);
    }
  }
}

int Lowering::element_index(int point) const {
  const DraftPoint& of = draft_.point(point);
  return of.index >= 0 ? of.index : static_cast<int>(lowered_.data.model.points.size()) + of.marker;
}

void Lowering::lower_elements() {
  for (const DraftBody& body : draft_.bodies) {
    Elements::Body element{body.name, {}, {}};
    const auto named = std::count_if(body.items.begin(), body.items.end(), [&](const auto& item) {
      return !draft_.point(item.point).is_own;
    });
    for (const DraftBody::Item& item : body.items) {
      const DraftPoint& point = draft_.point(item.point);
      if (point.is_own && named > 1) continue;  // a picture needs two points, no more
      (point.is_vector ? element.vectors : element.points).push_back(element_index(item.point));
    }
    lowered_.data.elements.bodies.push_back(std::move(element));
  }
  for (std::size_t i = 0; i < draft_.points.size(); ++i) {
    const DraftPoint& point = draft_.points[i];
    const bool is_named = point.node && !point.is_own;
    if (is_named || (point.index < 0 && point.marker < 0)) continue;
    lowered_.data.elements.helpers.push_back(element_index(static_cast<int>(i)));
  }
}

void Lowering::lower_outputs() {
  for (const DraftOutput& asked : draft_.outputs) {
    Output output = asked.output;
    if (output.kind == Output::Kind::constraint_force) {
      const auto found = forces_.find(asked.constraint);
      if (found == forces_.end()) {
        std::vector<std::string> names;
        for (const auto& [name, force] : forces_) names.push_back(name);
        std::sort(names.begin(), names.end());
        asked.node.get("constraint_force").fail_name("a rod or constraint", names);
      }
      const Force& force = found->second;
      output.force = force.kind;
      for (const Row row : force.rows) output.rows.push_back(rows_.place(row));
      output.first = {force.first.from, force.first.to};
      output.second = {force.second.from, force.second.to};
      output.factor = force.factor;
    }
    for (int* point : {&output.point, &output.first.from, &output.first.to, &output.second.from,
                       &output.second.to, &output.axis}) {
      if (*point >= 0) *point = element_index(*point);
    }
    lowered_.data.elements.outputs.push_back(std::move(output));
  }
}

/// In a table of all outputs, which starts with the time.
void Lowering::refuse_same_columns() const {
  std::unordered_map<std::string, std::string> owner_of{{"t", "the time"}};
  for (std::size_t i = 0; i < draft_.outputs.size(); ++i) {
    const JsonNode name = draft_.outputs[i].node.get("name");
    for (const std::string& column :
         columns_of(lowered_.data.elements.outputs[i], draft_.dimension)) {
      const auto [same, is_new] = owner_of.emplace(column, name.path());
      if (is_new) continue;
      name.fail(
          fmt::format("{}, which makes the column {}", in_quotes(name.text()), in_quotes(column)),
          fmt::format("columns of its own ({} has it)", same->second));
    }
  }
}

double Lowering::default_correction() const { return 0.1 * extent(lowered_.data.model.points); }

Vector3 Lowering::along(const DraftDirection& direction) const {
  return direction.from < 0 ? position(direction.to)
                            : position(direction.to) - position(direction.from);
}

Lowering::Edge Lowering::edge(const DraftDirection& direction) {
  return {index(direction.to), direction.from < 0 ? zero() : index(direction.from)};
}

int Lowering::zero() {
  if (zero_ >= 0) return zero_;
  for (const DraftPoint& point : draft_.points) {
    if (point.hold == Hold::fixed && !point.is_vector && *point.position == Vector3{}) {
      return zero_ = point.index;
    }
  }
  return zero_ = add_hidden("origin", false);
}

int Lowering::add_hidden(const std::string& name, bool is_vector) {
  DraftPoint point{name, std::nullopt, is_vector};
  while (!draft_.index_of.emplace(point.name, static_cast<int>(draft_.points.size())).second) {
    point.name += '_';
  }
  point.hold = Hold::fixed;
  point.position = Vector3{};
  add_point(point);
  const int index = point.index;
  draft_.points.push_back(std::move(point));
  return index;
}

void Lowering::remember(const JsonNode& node, Force force) {
  if (const auto name = node.find("name")) forces_.emplace(name->text(), std::move(force));
}

Lowered lower(SceneDraft& draft) { return Lowering(draft).run(); }

}  // namespace mbs
