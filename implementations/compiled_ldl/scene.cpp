// Patterns and rows of a model.
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace mbs::compiled_ldl {
namespace {

/// Free points by index of their first coordinate, as nodes of a pattern.
class Nodes {
 public:
  explicit Nodes(const Model& model) : model_(model), at_(model.variables(), -1) {
    for (const Point& point : model.points()) {
      if (!point.is_fixed()) at_[point.offset] = count_++;
    }
  }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int of_point(int point) const {
    return model_.points()[point].is_fixed() ? -1 : at_[model_.points()[point].offset];
  }
  [[nodiscard]] int of_coordinate(int k) const {
    while (at_[k] < 0) --k;
    return at_[k];
  }
  [[nodiscard]] std::vector<int> clique(std::initializer_list<int> points) const {
    std::vector<int> nodes;
    for (const int p : points) {
      const int node = of_point(p);
      if (node >= 0) nodes.push_back(node);
    }
    return sorted(std::move(nodes));
  }
  static std::vector<int> sorted(std::vector<int> nodes) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

 private:
  const Model& model_;
  std::vector<int> at_;
  int count_ = 0;
};

constexpr double kSmall = 1e-3;

/// Of each linear constraint a coordinate that no other has: that with the largest coefficient,
/// which is divided by; -1 where all are small beside the largest of the row.
std::vector<int> solved_coordinates(const Model& model) {
  std::vector<int> count(model.variables(), 0), solved;
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const auto& term : constraint.terms) ++count[term.coordinate];
  }
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    double largest = 0.0, of_solved = 0.0;
    int best = -1;
    for (const auto& term : constraint.terms) {
      const double size = std::fabs(term.coefficient);
      largest = std::max(largest, size);
      if (count[term.coordinate] > 1 || size <= of_solved) continue;
      best = term.coordinate;
      of_solved = size;
    }
    solved.push_back(of_solved > kSmall * largest ? best : -1);
  }
  return solved;
}

/// Of each border in front of `linear` a point that no other border has, unless it is far heavier
/// than the border's others, whose blocks its row would drown; -1 where there is none.
std::vector<int> points_alone(const Model& model, const Nodes& nodes,
                              const std::vector<std::vector<int>>& borders, std::size_t linear) {
  std::vector<int> count(nodes.count(), 0), alone;
  for (const auto& border : borders) {
    for (const int p : border) ++count[p];
  }
  std::vector<double> mass(nodes.count(), 0.0);
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == entry.col) mass[nodes.of_coordinate(entry.row)] = entry.value;
  }
  for (std::size_t m = 0; m < linear; ++m) {
    double lightest = HUGE_VAL;
    for (const int p : borders[m]) lightest = std::min(lightest, mass[p]);
    alone.push_back(-1);
    for (const int p : borders[m]) {
      if (count[p] == 1 && kSmall * mass[p] <= lightest) alone.back() = p;
    }
  }
  return alone;
}

}  // namespace

Pattern pattern_of(const Model& model, bool multipliers, bool second_derivatives) {
  const Nodes nodes(model);
  Pattern pattern;
  pattern.dimension = model.dimension();
  pattern.points = nodes.count();
  for (const MassEntry& entry : model.mass()) {
    pattern.cliques.push_back({nodes.of_coordinate(entry.row), nodes.of_coordinate(entry.col)});
  }
  pattern.constant = static_cast<int>(pattern.cliques.size());
  for (const Spring& s : model.springs()) pattern.cliques.push_back(nodes.clique({s.a, s.b}));
  for (const TorsionSpring& s : model.torsion_springs()) {
    pattern.cliques.push_back(nodes.clique({s.a, s.b, s.c, s.d}));
  }
  const auto add = [&](const std::vector<int>& clique, bool curved) {
    if (multipliers) pattern.borders.push_back(clique);
    if (!multipliers || (curved && second_derivatives)) pattern.cliques.push_back(clique);
  };
  for (const auto& c : model.dot_constraints()) add(nodes.clique({c.a, c.b, c.c, c.d}), true);
  for (const auto& c : model.bilinear_constraints()) add(nodes.clique({c.a, c.b, c.c, c.d}), true);
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    std::vector<int> clique;
    for (const auto& term : constraint.terms)
      clique.push_back(nodes.of_coordinate(term.coordinate));
    add(Nodes::sorted(std::move(clique)), false);
  }
  if (!multipliers) return pattern;
  pattern.solved = points_alone(model, nodes, pattern.borders,
                                pattern.borders.size() - model.linear_constraints().size());
  for (const int k : solved_coordinates(model)) {
    pattern.solved.push_back(k < 0 ? -1 : nodes.of_coordinate(k));
  }
  return pattern;
}

namespace {

/// M couples no axis with another, and has the same numbers in all of them.
bool has_mass_alike(const Model& model) {
  const int D = model.dimension();
  std::vector<int> first(model.variables());
  for (const Point& point : model.points()) {
    if (!point.is_fixed()) std::fill_n(first.begin() + point.offset, D, point.offset);
  }
  std::map<std::array<int, 2>, std::vector<double>> blocks;  // of two points: in each axis
  for (const MassEntry& entry : model.mass()) {
    const int row = first[entry.row], column = first[entry.col];
    if (entry.row - row != entry.col - column) return false;
    auto& block = blocks[{std::max(row, column), std::min(row, column)}];
    block.resize(D, 0.0);
    block[entry.row - row] += entry.value;
  }
  return std::all_of(blocks.begin(), blocks.end(), [](const auto& block) {
    const auto& of_axes = block.second;
    return std::all_of(of_axes.begin(), of_axes.end(), [&](double x) { return x == of_axes[0]; });
  });
}

}  // namespace

Changing changing_of(const Model& model) {
  const auto& dots = model.dot_constraints();
  const bool distances = model.bilinear_constraints().empty() &&
                         std::ranges::all_of(dots, &DotConstraint::is_distance);
  return {distances ? model.dimension() : 2 * model.dimension(),
          model.linear_constraints().empty() && has_mass_alike(model)};
}

Program program_of(const Model& model, const StepSettings& settings, int width) {
  const bool stiff = !model.springs().empty() || !model.torsion_springs().empty();
  const bool constant = has_multiplier_rows(settings) && (is_rattle(settings) || !stiff) &&
                        !settings.geometric_stiffness &&
                        settings.precision == Precision::double_precision;
  return compile(pattern_of(model, has_multiplier_rows(settings), settings.geometric_stiffness),
                 width, constant ? changing_of(model) : Changing{});
}

Rows::Rows(const Model& model, const Program& program)
    : of_point(model.points().size()), of_coordinate(model.variables()), free_(program.padded) {
  extent = program.padded;
  int node = 0;
  for (std::size_t i = 0; i < model.points().size(); ++i) {
    const Point& point = model.points()[i];
    if (point.is_fixed()) {
      of_point[i] = extent;
      extent += model.dimension();
      continue;
    }
    of_point[i] = program.row_of_node[node++];
    for (int x = 0; x < model.dimension(); ++x) of_coordinate[point.offset + x] = of_point[i] + x;
  }
}

namespace {

/// Sums at a point wait for each other. So pairs that share one are kept four places apart, where
/// one of the next sixteen pairs can be taken instead.
void keep_apart(const std::vector<Pair>& all, const Rows& rows, std::span<int> order) {
  constexpr int kApart = 4, kAhead = 16;
  std::vector<int> last(rows.extent, -kApart);
  for (int k = 0; k < static_cast<int>(order.size()); ++k) {
    int best = k, most = -1;
    for (int i = k; i < std::min<int>(k + kAhead, order.size()) && most < kApart; ++i) {
      const Pair& pair = all[order[i]];
      int apart = k - last[pair.a];
      if (rows.is_free(pair.b)) apart = std::min(apart, k - last[pair.b]);
      if (apart > most) most = apart, best = i;
    }
    std::rotate(order.begin() + k, order.begin() + best, order.begin() + best + 1);
    last[all[order[k]].a] = last[all[order[k]].b] = k;
  }
}

}  // namespace

Pairs make_pairs(const std::vector<std::array<int, 2>>& points, const Rows& rows,
                 std::vector<int>& order) {
  std::vector<Pair> all;
  for (const auto& [p, q] : points) {
    Pair pair;
    pair.a = std::min(rows.of_point[p], rows.of_point[q]);
    pair.b = std::max(rows.of_point[p], rows.of_point[q]);
    all.push_back(pair);
  }
  const auto free = [&](const Pair& pair) { return rows.is_free(pair.a) + rows.is_free(pair.b); };
  order.resize(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
    if (free(all[i]) != free(all[j])) return free(all[i]) > free(all[j]);
    return all[i].a < all[j].a;
  });
  const auto two =
      std::count_if(all.begin(), all.end(), [&](const Pair& p) { return free(p) == 2; });
  keep_apart(all, rows, std::span(order).first(two));
  Pairs pairs;
  for (const int k : order) pairs.list.push_back(all[k]);
  for (const Pair& pair : pairs.list) {
    pairs.two += free(pair) == 2;
    pairs.one += free(pair) >= 1;
  }
  return pairs;
}

Quad make_quad(const std::array<int, 4>& points, const Rows& rows, const Program& program,
               std::vector<Place>* places) {
  Quad quad;
  quad.a = rows.of_point[points[0]];
  quad.b = rows.of_point[points[1]];
  quad.c = rows.of_point[points[2]];
  quad.d = rows.of_point[points[3]];
  const auto add = [&](int row, double sign_a, double sign_c) {
    if (!rows.is_free(row)) return;
    int i = 0;
    while (i < quad.free && quad.points[i].row < row) ++i;
    if (i == quad.free || quad.points[i].row != row) {  // kept sorted
      for (int j = quad.free++; j > i; --j) quad.points[j] = quad.points[j - 1];
      quad.points[i] = {row, 0.0, 0.0};
    }
    quad.points[i].sign_a += sign_a;
    quad.points[i].sign_c += sign_c;
  };
  add(quad.a, 1.0, 0.0);
  add(quad.b, -1.0, 0.0);
  add(quad.c, 0.0, 1.0);
  add(quad.d, 0.0, -1.0);
  if (places == nullptr) return quad;
  quad.places = static_cast<int>(places->size());
  for (int i = 0; i < quad.free; ++i) {
    for (int j = i; j < quad.free; ++j) {
      places->push_back(place_of(program, quad.points[j].row, quad.points[i].row));
    }
  }
  return quad;
}

void place_pairs(Pairs& pairs, const Program& program) {
  for (int k = 0; k < pairs.one; ++k) {
    Pair& pair = pairs.list[k];
    pair.aa = place_of(program, pair.a, pair.a);
    if (k >= pairs.two) continue;
    pair.bb = place_of(program, pair.b, pair.b);
    pair.ba = place_of(program, pair.b, pair.a);
  }
}

}  // namespace mbs::compiled_ldl
