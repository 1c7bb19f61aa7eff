// Puts the free points of a model into the order of a chain, if they are one.
#include "topology.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mbs::compiled_chains {
namespace topology {

/// The free points as numbers 0, 1, … by their place in q: each has two entries.
struct Graph {
  std::vector<std::array<int, 2>> neighbours;  // -1: none
  std::vector<int> degree;

  bool connect(int a, int b) {
    for (int k = 0; k < degree[a]; ++k) {
      if (neighbours[a][k] == b) return true;
    }
    if (degree[a] == 2 || degree[b] == 2) return false;
    neighbours[a][degree[a]++] = b;
    neighbours[b][degree[b]++] = a;
    return true;
  }
};

bool has_vectors(const Model& model) {
  return std::ranges::any_of(model.points(), &Point::is_vector);
}

std::optional<Graph> graph_of(const Model& model) {
  const int count = model.variables() / 2;
  Graph graph{std::vector<std::array<int, 2>>(count, {-1, -1}), std::vector<int>(count, 0)};
  for (const MassEntry& entry : model.mass()) {
    const int a = entry.row / 2;
    const int b = entry.col / 2;
    if (a != b && !graph.connect(a, b)) return std::nullopt;
  }
  for (const DotConstraint& row : model.dot_constraints()) {
    if (row.a == row.b) return std::nullopt;
    const Point& a = model.points()[row.a];
    const Point& b = model.points()[row.b];
    if (a.is_fixed() && b.is_fixed()) return std::nullopt;
    if (a.is_fixed() || b.is_fixed()) continue;
    if (!graph.connect(a.offset / 2, b.offset / 2)) return std::nullopt;
  }
  return graph;
}

/// Paths from end to end, one after the other; nothing if there is a cycle.
std::optional<std::vector<int>> order_of(const Graph& graph) {
  std::vector<int> order;
  std::vector<bool> seen(graph.degree.size(), false);
  for (int start = 0; start < static_cast<int>(graph.degree.size()); ++start) {
    if (seen[start] || graph.degree[start] == 2) continue;
    for (int at = start; at >= 0;) {
      order.push_back(at);
      seen[at] = true;
      int next = -1;
      for (const int other : graph.neighbours[at]) {
        if (other >= 0 && !seen[other]) next = other;
      }
      at = next;
    }
  }
  if (order.size() != graph.degree.size()) return std::nullopt;
  return order;
}

/// Takes masses and forces in; false if a block is not between neighbours in the order.
void add_mass(const Model& model, const std::vector<int>& place_of, Topology& chain) {
  for (const MassEntry& entry : model.mass()) {
    int row = place_of[entry.row / 2];
    int column = place_of[entry.col / 2];
    int row_axis = entry.row % 2;
    int column_axis = entry.col % 2;
    if (row == column) {
      chain.places[row].mass[row_axis + column_axis] = entry.value;
      continue;
    }
    if (row > column) {
      std::swap(row, column);
      std::swap(row_axis, column_axis);
    }
    chain.places[row].coupling[2 * row_axis + column_axis] = entry.value;
  }
  for (Place& place : chain.places) {
    place.force = {model.force()[place.coordinate], model.force()[place.coordinate + 1]};
    const auto& [xx, xy, yy] = place.mass;
    const auto& c = place.coupling;
    if (xy != 0.0 || xx != yy || c[1] != 0.0 || c[2] != 0.0 || c[0] != c[3]) {
      chain.isotropic = false;
    }
  }
  chain.coupling = std::max(0.0, chain.places[0].coupling[0]);
  for (std::size_t k = 1; k + 1 < chain.places.size(); ++k) {
    if (chain.places[k].coupling[0] != chain.coupling) chain.coupling = 0.0;
  }
  // Units make the coupling 1: numbers of which products of three are taken must not be huge then.
  const auto by_mass = [](const Place& a, const Place& b) { return a.mass[0] < b.mass[0]; };
  const double most = std::ranges::max_element(chain.places, by_mass)->mass[0];
  if (!chain.isotropic || !(chain.coupling > 1e-20 * most)) chain.coupling = 0.0;
}

/// A point is kept relative to the first fixed one that it has a distance to, else to what the
/// point beside it in the chain is kept relative to: coordinates far off lose no digits.
void set_origins(const Model& model, const std::vector<int>& place_of, Topology& chain) {
  std::vector<int> anchor(chain.places.size(), -1);
  for (const DotConstraint& row : model.dot_constraints()) {
    const Point& a = model.points()[row.a];
    const Point& b = model.points()[row.b];
    if (!a.is_fixed() && !b.is_fixed()) continue;
    int& first = anchor[place_of[(a.is_fixed() ? b : a).offset / 2]];
    if (first < 0) first = a.is_fixed() ? row.a : row.b;
  }
  for (std::size_t k = 1; k < anchor.size(); ++k) {
    if (anchor[k] < 0) anchor[k] = anchor[k - 1];
  }
  for (std::size_t k = anchor.size() - 1; k > 0; --k) {
    if (anchor[k - 1] < 0) anchor[k - 1] = anchor[k];
  }
  for (std::size_t k = 0; k < anchor.size(); ++k) {
    const int coordinate = chain.places[0].coordinate;
    chain.places[k].origin = anchor[k] < 0
                                 ? std::array<double, 2>{model.initial_position()[coordinate],
                                                         model.initial_position()[coordinate + 1]}
                                 : std::array<double, 2>{model.points()[anchor[k]].position[0],
                                                         model.points()[anchor[k]].position[1]};
  }
}

Distance distance_between(int row, double value, const std::array<double, 2>& from,
                          const std::array<double, 2>& to) {
  return {row, {to[0] - from[0], to[1] - from[1]}, value};
}

/// Links whose offsets differ by the rounding of coordinates alone get the same: blocks share it.
/// Not where coordinates are so far off that this would be felt in an offset.
void make_offsets_equal(Topology& chain) {
  constexpr double kUnfelt = 2e-13;
  for (std::size_t k = 1; k + 1 < chain.places.size(); ++k) {
    const auto& link = chain.places[k].link.offset;
    const double felt = kUnfelt * std::hypot(link[0], link[1]);
    for (int axis = 0; axis < 2; ++axis) {
      const double before = chain.places[k - 1].link.offset[axis];
      double& offset = chain.places[k].link.offset[axis];
      const double largest = std::max(std::abs(chain.places[k].origin[axis]),
                                      std::abs(chain.places[k + 1].origin[axis]));
      const double rounding = 2.0 * std::numeric_limits<double>::epsilon() * largest;
      if (std::abs(offset - before) <= std::min(rounding, felt)) offset = before;
    }
  }
}

/// False if there are more distances at a point or between two than this folder's chain has.
bool add_distances(const Model& model, const std::vector<int>& place_of, Topology& chain) {
  const auto rows = model.dot_constraints();
  std::vector<int> rods(chain.places.size(), 0);
  for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
    const Point& a = model.points()[rows[k].a];
    const Point& b = model.points()[rows[k].b];
    if (a.is_fixed() || b.is_fixed()) {
      const Point& fixed = a.is_fixed() ? a : b;
      const int at = place_of[(a.is_fixed() ? b : a).offset / 2];
      if (rods[at] == kMostRods) return false;
      Place& place = chain.places[at];
      place.rods[rods[at]++] =
          distance_between(k, rows[k].value, {fixed.position[0], fixed.position[1]}, place.origin);
      continue;
    }
    const auto [first, second] = std::minmax({place_of[a.offset / 2], place_of[b.offset / 2]});
    Distance& link = chain.places[first].link;
    if (link.row >= 0) return false;
    link =
        distance_between(k, rows[k].value, chain.places[first].origin, chain.places[second].origin);
  }
  make_offsets_equal(chain);
  const auto [least, most] = std::minmax_element(rods.begin(), rods.end());
  chain.least_rods = *least;
  chain.most_rods = *most;
  return true;
}

}  // namespace topology

std::optional<Topology> find_chain(const Model& model) {
  if (model.variables() == 0 || topology::has_vectors(model)) return std::nullopt;
  const auto graph = topology::graph_of(model);
  if (!graph) return std::nullopt;
  const auto order = topology::order_of(*graph);
  if (!order) return std::nullopt;
  Topology chain;
  chain.places.resize(order->size());
  std::vector<int> place_of(order->size());
  for (std::size_t k = 0; k < order->size(); ++k) {
    place_of[(*order)[k]] = static_cast<int>(k);
    chain.places[k].coordinate = 2 * (*order)[k];
  }
  topology::add_mass(model, place_of, chain);
  topology::set_origins(model, place_of, chain);
  if (!topology::add_distances(model, place_of, chain)) return std::nullopt;
  return chain;
}

}  // namespace mbs::compiled_chains
