// Orders to choose from, and what a pass takes with each.
#include "best_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "ordering.hpp"

namespace mbs::compiled_ldl {
namespace {

/// Points that have to go before each multiplier: of a substitution the one that it is solved for.
/// Another has, in place of what is solved for, the other points of that substitution.
std::vector<std::vector<int>> points_before(const Pattern& pattern) {
  const auto count = static_cast<int>(pattern.borders.size());
  std::vector<std::vector<int>> before = pattern.borders, others(pattern.points);
  for (int m = 0; m < count; ++m) {
    if (!pattern.is_substitution(m)) continue;
    before[m] = {pattern.solved[m]};
    auto& of_point = others[pattern.solved[m]];
    of_point.insert(of_point.end(), pattern.borders[m].begin(), pattern.borders[m].end());
  }
  for (int m = 0; m < count; ++m) {
    if (pattern.is_substitution(m)) continue;
    for (const int p : pattern.borders[m]) {
      before[m].insert(before[m].end(), others[p].begin(), others[p].end());
    }
  }
  return before;
}

/// Every multiplier comes right after the last of these points: late enough that a large alpha
/// costs no digits, early enough that it costs no fill. Substitutions come first: what is solved
/// for may be light, and is to lean on nothing but its own rows.
std::vector<int> insert_multipliers(const std::vector<int>& points, const Pattern& pattern) {
  std::vector<int> place(pattern.points);
  for (int k = 0; k < pattern.points; ++k) place[points[k]] = k;
  const std::vector<std::vector<int>> before = points_before(pattern);
  std::vector<std::vector<int>> after(pattern.points + 1);
  for (const bool substitutions : {true, false}) {
    for (int m = 0; m < static_cast<int>(before.size()); ++m) {
      if (pattern.is_substitution(m) != substitutions) continue;
      int last = pattern.points;
      for (const int p : before[m]) {
        last = last == pattern.points ? place[p] : std::max(last, place[p]);
      }
      after[last].push_back(pattern.points + m);
    }
  }
  std::vector<int> order;
  for (int k = 0; k <= pattern.points; ++k) {
    if (k < pattern.points) order.push_back(points[k]);
    order.insert(order.end(), after[k].begin(), after[k].end());
  }
  return order;
}

/// How often the nodes of fronts that borders name do not follow each other, by front. `place`: of
/// each node among the pivots of its front.
std::vector<int> gaps_in_borders(const Tree& tree, const std::vector<int>& front_of_node,
                                 const std::vector<int>& place) {
  std::vector<int> gaps(tree.fronts.size(), 0);
  for (const TreeFront& front : tree.fronts) {
    std::vector<std::array<int, 2>> named;  // front, place
    for (const int node : front.border) named.push_back({front_of_node[node], place[node]});
    std::sort(named.begin(), named.end());
    for (std::size_t i = 1; i < named.size(); ++i) {
      const bool same = named[i][0] == named[i - 1][0];
      if (same && named[i][1] != named[i - 1][1] + 1) ++gaps[named[i][0]];
    }
  }
  return gaps;
}

// Points eliminated once and for all.

/// Multipliers that are coupled when all points are eliminated: those of each connected part of the
/// points.
std::vector<std::vector<int>> cliques_of_multipliers(const Pattern& pattern) {
  std::vector<int> part(pattern.points);
  std::iota(part.begin(), part.end(), 0);
  const auto find = [&](int p) {
    while (part[p] != p) p = part[p] = part[part[p]];
    return p;
  };
  for (const auto& clique : pattern.cliques) {
    for (const int p : clique) part[find(p)] = find(clique[0]);
  }
  std::vector<std::vector<int>> cliques(pattern.points);
  for (int m = 0; m < static_cast<int>(pattern.borders.size()); ++m) {
    for (const int p : pattern.borders[m]) {
      auto& clique = cliques[find(p)];
      if (clique.empty() || clique.back() != m) clique.push_back(m);
    }
  }
  return cliques;
}

/// Cycles of `solves` substitutions with the factors of a tree.
double cycles_of_solves(const Tree& tree, const Pattern& pattern, int width, double solves) {
  const std::vector<int> sizes = sizes_of(pattern);
  double cycles = 0.0;
  for (const TreeFront& front : tree.fronts) {
    double pivots = 0.0, border = 0.0;
    for (const int node : front.pivots) pivots += sizes[node];
    for (const int node : front.border) border += sizes[node];
    cycles += pivots * (4.0 + turns_of_pack(width) * (pivots + 2.0 * border) / width);
  }
  return solves * cycles;
}

/// Cycles in which the numbers of −ε − B A⁻¹ Bᵀ are found, with those of so many rows in a clique.
double cycles_of_products(double rows, int width, int products) {
  return 0.7 * turns_of_pack(width) * products * rows * (rows + width) / (2 * width);
}
/// Cycles of a product with the inverse of the points' block.
double cycles_of_inverse(const Pattern& points, int width, bool axes_alike) {
  const int axes = axes_alike ? points.dimension : 1;
  const double rows = points.points * points.dimension / axes;
  const double packs = std::ceil(rows / width) * turns_of_pack(width);
  return rows * (packs * (0.4 + 0.35 * axes) + (axes_alike ? axes : 0)) + 20.0;
}
/// Cycles in which B, no part of the matrix any more, is written and multiplied with, of so many
/// rows and numbers in each. Those of one panel need no turns, as was measured.
double cycles_of_numbers(int rows, int numbers, int width) {
  return 12.0 * rows * numbers * (rows > kPanel ? turns_of_pack(width) : 1.0);
}

}  // namespace

std::vector<int> sizes_of(const Pattern& pattern) {
  std::vector<int> sizes(pattern.points + pattern.borders.size(), 1);
  std::fill_n(sizes.begin(), pattern.points, pattern.dimension);
  return sizes;
}

Tree best_tree(const Pattern& pattern, int width) {
  const std::vector<int> sizes = sizes_of(pattern);
  auto cliques = pattern.cliques;
  cliques.insert(cliques.end(), pattern.borders.begin(), pattern.borders.end());
  const Graph points = graph_of(pattern.points, cliques);
  cliques = pattern.cliques;
  for (int m = 0; m < static_cast<int>(pattern.borders.size()); ++m) {
    for (const int p : pattern.borders[m]) cliques.push_back({pattern.points + m, p});
  }
  const int nodes = pattern.points + static_cast<int>(pattern.borders.size());
  const Graph all = pattern.borders.empty() ? points : graph_of(nodes, cliques);
  std::vector<int> given(pattern.points);
  std::iota(given.begin(), given.end(), 0);
  const std::vector<std::vector<int>> orders = {minimum_degree(points, Tie::longest),
                                                minimum_degree(points, Tie::latest),
                                                from_both_ends(points), given};
  const auto fastest = [&](const Pattern& of, std::size_t most) {
    Tree best;
    for (const auto& order : orders) {
      Tree tree = eliminate(all, insert_multipliers(order, of), sizes, width, most);
      if (tree.fronts.empty()) continue;
      // An order with many times the fill is not the fastest, and may not fit the memory: a star's
      // from both ends.
      if (best.fronts.empty()) most = std::min(most, 4 * tree.fill);
      if (best.fronts.empty() || tree.cycles < best.cycles) best = std::move(tree);
    }
    return best;
  };
  Tree best = fastest(pattern, std::numeric_limits<std::size_t>::max() / 4);
  if (std::all_of(pattern.solved.begin(), pattern.solved.end(), [](int p) { return p < 0; })) {
    return best;
  }
  // Substitutions make less fill, so solves are shorter too.
  constexpr double kLittle = 1.05;
  Pattern waiting = pattern;
  waiting.solved.clear();
  Tree late = fastest(waiting, 4 * best.fill);
  return late.fronts.empty() || best.cycles < kLittle * late.cycles ? best : late;
}

void close_gaps(const Pattern& pattern, Tree& tree) {
  const std::size_t nodes = pattern.points + pattern.borders.size();
  std::vector<int> front_of_node(nodes), place(nodes), closed_place(nodes);
  std::vector<bool> is_named(nodes, false);
  for (const TreeFront& front : tree.fronts) {
    for (const int node : front.border) is_named[node] = true;
  }
  const auto stays = [&](int node) {
    return node < pattern.points || is_named[node] ||
           pattern.is_substitution(node - pattern.points);
  };
  std::vector<std::vector<int>> closed;
  for (std::size_t k = 0; k < tree.fronts.size(); ++k) {
    std::vector<int> pivots = tree.fronts[k].pivots;
    for (int i = 0; i < static_cast<int>(pivots.size()); ++i) {
      front_of_node[pivots[i]] = static_cast<int>(k);
      place[pivots[i]] = i;
    }
    std::stable_partition(pivots.begin(), pivots.end(), stays);
    for (int i = 0; i < static_cast<int>(pivots.size()); ++i) closed_place[pivots[i]] = i;
    closed.push_back(std::move(pivots));
  }
  const std::vector<int> before = gaps_in_borders(tree, front_of_node, place);
  const std::vector<int> after = gaps_in_borders(tree, front_of_node, closed_place);
  for (std::size_t k = 0; k < tree.fronts.size(); ++k) {
    if (after[k] < before[k]) tree.fronts[k].pivots = std::move(closed[k]);
  }
}

int eliminate_points_first(const Pattern& pattern, int width, const Changing& changing, Tree& tree,
                           bool& inverts) {
  const double before = tree.cycles + cycles_of_solves(tree, pattern, width, 2.0);
  Pattern multipliers{.dimension = 1,
                      .points = static_cast<int>(pattern.borders.size()),
                      .cliques = cliques_of_multipliers(pattern),
                      .borders = {}};
  double after = cycles_of_numbers(multipliers.points, changing.numbers, width);
  const int of_entry = changing.products(pattern.dimension);
  for (const auto& clique : multipliers.cliques) {
    after += cycles_of_products(static_cast<double>(clique.size()), width, of_entry);
  }
  if (after >= before) return 0;  // which may have too many couplings to go on
  const Pattern points{.dimension = pattern.dimension,
                       .points = pattern.points,
                       .cliques = pattern.cliques,
                       .borders = {}};
  Tree constant = best_tree(points, width), rest = best_tree(multipliers, width);
  // Two solves, and nothing hides their latencies.
  const double substitutions = cycles_of_solves(constant, points, width, 3.0);
  const double products = 2.0 * cycles_of_inverse(points, width, changing.axes_alike);
  // Separate blocks of A are substituted side by side, so the inverse must be clearly faster.
  const bool inverse = 2.0 * products < substitutions;
  after += rest.cycles + cycles_of_solves(rest, multipliers, width, 2.0) +
           (inverse ? products : substitutions);
  if (after >= before) return 0;
  inverts = inverse;
  tree = std::move(constant);
  const auto fronts = static_cast<int>(tree.fronts.size());
  tree.cycles = rest.cycles;
  for (TreeFront& front : rest.fronts) {
    for (auto* nodes : {&front.pivots, &front.border}) {
      for (int& node : *nodes) node += pattern.points;
    }
    tree.fronts.push_back(std::move(front));
  }
  return fronts;
}

}  // namespace mbs::compiled_ldl
