// Numbers the points, then lowers the kinds in the order of their table.
#include "scene_file/lowering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model_math/extent.hpp"
#include "printable.hpp"
#include "scene/time_functions.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {

Lowered Lowering::run() {
  model().dimension = draft_.dimension;
  number_points();
  mass_.emplace(model());
  for (const ListKind& kind : list_kinds()) {
    if (kind.lower != nullptr) kind.lower(*this);
  }
  mass_->finish();
  elements().driven_energy = mass_->driven_energy();
  rows_.finish();
  add_elements();
  elements().drivers = std::move(draft_.drivers);
  elements().inputs = std::move(draft_.inputs);
  lowered_.data.largest_correction =
      draft_.largest_correction.value_or(0.1 * extent(model().points));
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
  for (DraftForce& force : draft_.forces) {
    const auto is_driven = [](const TimeFunction& axis) { return !axis.is_constant(); };
    if (std::ranges::any_of(force.driven, is_driven)) add_pusher(force);
  }
}

/// A force that is a function of time: what the mass of a driven point would put into Q.
void Lowering::add_pusher(DraftForce& force) {
  DraftPoint point{force.node.path()};
  point.hold = Hold::driven;
  point.position = position(force.point);  // so that the scene's extent stays
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point.motion[axis] = pushing(force.driven[axis], (*point.position)[axis]);
  }
  force.pusher = add_hidden(std::move(point));
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

int Lowering::element_index(int point) const {
  const DraftPoint& of = draft_.point(point);
  return of.index >= 0 ? of.index : static_cast<int>(lowered_.data.model.points.size()) + of.marker;
}

void Lowering::add_elements() {
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
    elements().bodies.push_back(std::move(element));
  }
  for (std::size_t i = 0; i < draft_.points.size(); ++i) {
    const DraftPoint& point = draft_.points[i];
    const bool is_named = point.node && !point.is_own;
    if (is_named || (point.index < 0 && point.marker < 0)) continue;
    elements().helpers.push_back(element_index(static_cast<int>(i)));
  }
}

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
  point.hold = Hold::fixed;
  point.position = Vector3{};
  return add_hidden(std::move(point));
}

int Lowering::add_hidden(DraftPoint point) {
  while (!draft_.index_of.emplace(point.name, static_cast<int>(draft_.points.size())).second) {
    point.name += '_';
  }
  add_point(point);
  const int index = point.index;
  draft_.points.push_back(std::move(point));
  return index;
}

void Lowering::remember(const JsonNode& node, Force force) {
  if (force.kind == Output::Force::torque) torques_.push_back(force);
  if (const auto name = node.find("name")) forces_.emplace(name->text(), std::move(force));
}

std::vector<RowWriter::Part> Lowering::fixed_dot(const Vector3& fixed,
                                                 const DraftDirection& moving) const {
  std::vector<Part> parts;
  for (int axis = 0; axis < draft_.dimension; ++axis) {
    const double coefficient = fixed[static_cast<std::size_t>(axis)];
    parts.push_back({index(moving.to), axis, coefficient});
    if (moving.from >= 0) parts.push_back({index(moving.from), axis, -coefficient});
  }
  return parts;
}

void Lowering::refuse_same_dot(const JsonNode& node, const DraftDirection& first,
                               const DraftDirection& second) {
  // Orders within and of the pairs change at most the sign.
  std::pair<int, int> x = std::minmax(first.from, first.to);
  std::pair<int, int> y = std::minmax(second.from, second.to);
  if (y < x) std::swap(x, y);
  const auto [same, is_new] =
      dots_.emplace(std::array<int, 4>{x.first, x.second, y.first, y.second}, node.path());
  if (!is_new) {
    node.fail("the same points as in " + same->second,
              "one rod or constraint between the same points, another is redundant");
  }
}

void Lowering::distinct_linear(const JsonNode& node, const std::string& name,
                               const std::vector<Part>& parts, const TimeFunction& value) {
  rows_.linear(name, parts, value);
  const LinearConstraint& written = model().linear_constraints.back();
  const double scale = written.terms.front().coefficient;
  std::vector<std::pair<int, double>> scaled;
  for (const auto& term : written.terms) {
    scaled.emplace_back(term.coordinate, term.coefficient / scale);
  }
  const Known own{node.path(), written.value / scale};
  const auto [same, is_new] = linears_.emplace(std::move(scaled), own);
  if (is_new) return;
  const Known& other = same->second;
  constexpr double kSame = 1e-12;  // of the value: rounding
  const bool agrees = std::abs(own.value - other.value) <= kSame * std::abs(own.value);
  node.fail("the same coefficients as in " + other.path + " or a multiple" +
                (agrees ? ""
                        : fmt::format(", but the value {:.9g} m where that has {:.9g} m: they "
                                      "contradict each other",
                                      own.value, other.value)),
            agrees ? "one such constraint, another is redundant" : "one such constraint");
}

std::optional<double> Lowering::constant_length(const DraftDirection& direction) const {
  if (direction.from < 0) return 1.0;
  if (draft_.is_fixed(direction)) return norm(along(direction));
  const auto known = lengths_.find(std::minmax({index(direction.from), index(direction.to)}));
  if (known != lengths_.end()) return known->second;
  const int shared = common_body(draft_, {direction.from, direction.to});
  if (shared < 0) return std::nullopt;
  std::array<Vector3, 2> ends{};
  for (const DraftBody::Item& item : draft_.body(shared).items) {
    if (item.point == direction.from) ends[0] = item.local;
    if (item.point == direction.to) ends[1] = item.local;
  }
  return norm(ends[1] - ends[0]);
}

Lowered lower(SceneDraft& draft) { return Lowering(draft).run(); }

}  // namespace mbs
