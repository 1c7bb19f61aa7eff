// Compiles a pattern: ordering, fronts, positions of everything.
#include "program.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "elimination_tree.hpp"
#include "ordering.hpp"
#include "panels/vectors.hpp"

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

/// Multipliers that no border names go behind the other pivots of their front, where this closes
/// gaps between those that borders name: updates have fewer and longer strips then. Substitutions
/// stay where they are.
void close_gaps(const Pattern& pattern, Tree& tree) {
  const std::size_t nodes = pattern.points + pattern.borders.size();
  std::vector<int> front_of_node(nodes), place(nodes), closed_place(nodes);
  std::vector<bool> is_named(nodes, false);
  for (const TreeFront& front : tree.fronts) {
    for (const int node : front.border) is_named[node] = true;
  }
  const auto stays = [&](int node) {
    return node < pattern.points || is_named[node] || pattern.is_substitution(node - pattern.points);
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
    cycles += pivots * (4.0 + (pivots + 2.0 * border) / width);
  }
  return solves * cycles;
}

/// Cycles in which the numbers of −ε − B A⁻¹ Bᵀ are found, with those of so many rows in a clique.
double cycles_of_products(double rows, int width, int products) {
  return 0.7 * products * rows * (rows + width) / (2 * width);
}
/// Cycles of a product with the inverse of the points' block.
double cycles_of_inverse(const Pattern& points, int width, bool axes_alike) {
  const int axes = axes_alike ? points.dimension : 1;
  const double rows = points.points * points.dimension / axes;
  return rows * (std::ceil(rows / width) * (0.4 + 0.35 * axes) + (axes_alike ? axes : 0)) + 20.0;
}
/// Cycles in which B, no part of the matrix any more, is written and multiplied with, a row and
/// number.
constexpr double kCyclesOfNumber = 12.0;

/// Replaces `tree` by the points' fronts and those of −ε − B A⁻¹ Bᵀ, if a pass of Newton's method
/// is predicted to take less time with them; the number of the points' fronts, 0: nothing is
/// replaced.
int eliminate_points_first(const Pattern& pattern, int width, const Changing& changing, Tree& tree,
                           bool& inverts) {
  const double before = tree.cycles + cycles_of_solves(tree, pattern, width, 2.0);
  Pattern multipliers{.dimension = 1,
                      .points = static_cast<int>(pattern.borders.size()),
                      .cliques = cliques_of_multipliers(pattern),
                      .borders = {}};
  double after = kCyclesOfNumber * changing.numbers * multipliers.points;
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

/// Columns long enough for vectors of 2, 4 or 8 numbers that begin below the pivots of a panel. In
/// a front of one panel those of 8 may reach into what the next column keeps of the pivots, which
/// are in registers by then, and behind the last column into kBehind numbers. Columns of wide
/// fronts are whole blocks of eight numbers, and do not all begin in the same few places of a
/// cache.
int stride_of(const Front& front, int width) {
  const int rows = front.pivots + front.border;
  if (width == 1) return rows;
  if (front.pivots > kPanel) {
    const int blocks = round_up(front.pivots + round_up(front.border, kPanel), kPanel);
    return blocks % 128 == 0 ? blocks + kPanel : blocks;
  }
  int stride = std::max(lanes_for(front.pivots), rows);
  if (front.border > 0) {
    const int lanes = lanes_for(front.border), rounded = round_up(front.border, lanes);
    stride = std::max(rows, lanes == 8 ? rounded : front.pivots + rounded);
  }
  return stride <= 4 ? stride : round_up(stride, 4);
}
constexpr int kBehind = 8;

void place_rows(const Tree& tree, const std::vector<int>& sizes, Program& program) {
  program.row_of_node.resize(sizes.size());
  for (const TreeFront& from : tree.fronts) {
    Front front;
    front.first = program.size;
    front.base = program.storage;
    for (const int node : from.pivots) {
      program.row_of_node[node] = program.size;
      program.size += sizes[node];
    }
    for (const int node : from.border) front.border += sizes[node];
    front.pivots = program.size - front.first;
    front.stride = stride_of(front, program.width);
    program.storage += front.pivots * front.stride;
    if (program.width > 1 && front.border > 4) program.storage += kBehind;
    program.storage = round_up(program.storage, program.width);
    program.front_of_row.resize(program.size, static_cast<int>(program.fronts.size()));
    program.fronts.push_back(front);
  }
  program.padded = round_up(program.size, 8) + 8;
}

void place_borders(const Tree& tree, const std::vector<int>& sizes, Program& program) {
  for (std::size_t k = 0; k < tree.fronts.size(); ++k) {
    Front& front = program.fronts[k];
    front.rows = static_cast<int>(program.border_rows.size());
    for (const int node : tree.fronts[k].border) {
      for (int i = 0; i < sizes[node]; ++i) {
        program.border_rows.push_back(program.row_of_node[node] + i);
      }
    }
    std::sort(program.border_rows.begin() + front.rows, program.border_rows.end());
  }
}

int place_in(const Program& program, const Front& front, int row) {
  if (row < front.first + front.pivots) return row - front.first;
  const auto begin = program.border_rows.begin() + front.rows;
  const auto found = std::lower_bound(begin, begin + front.border, row);
  return front.pivots + static_cast<int>(found - begin);
}

void place_updates(Program& program) {
  for (Front& front : program.fronts) {
    front.groups_begin = static_cast<int>(program.groups.size());
    const int* rows = program.border_rows.data() + front.rows;
    for (int k = 0; k < front.border;) {
      const Front& target = program.fronts[program.front_of_row[rows[k]]];
      Group group;
      group.begin = k;
      while (k < front.border && rows[k] < target.first + target.pivots) ++k;
      group.end = k;
      group.base = target.base + (rows[group.begin] - target.first) * target.stride;
      // The columns of a group need not be neighbours in the target: split where they are not.
      for (int i = group.begin + 1; i < group.end; ++i) {
        if (rows[i] != rows[i - 1] + 1) group.end = k = i;
      }
      group.stride = target.stride;
      group.positions = static_cast<int>(program.positions.size());
      for (int i = group.begin; i < front.border; ++i) {
        program.positions.push_back(place_in(program, target, rows[i]));
      }
      const auto* places = program.positions.data() + group.positions;
      group.contiguous =
          places[front.border - group.begin - 1] - places[0] == front.border - group.begin - 1;
      program.groups.push_back(group);
    }
    front.groups_end = static_cast<int>(program.groups.size());
  }
}

/// Marks what elements add to, and what fronts subtract from or write into.
class Changes {
 public:
  Changes(const Program& program) : program_(program), is_changed_(program.storage / 8 + 1) {}

  void of_elements(const Pattern& pattern, const std::vector<int>& sizes) {
    for (std::size_t c = pattern.constant; c < pattern.cliques.size(); ++c) {
      for (const int p : pattern.cliques[c]) {
        for (const int q : pattern.cliques[c]) couple(p, q, sizes);
      }
    }
    for (std::size_t m = 0; m < pattern.borders.size(); ++m) {
      const int multiplier = pattern.points + static_cast<int>(m);
      for (const int p : pattern.borders[m]) couple(multiplier, p, sizes);
    }
  }
  void of_fronts() {
    for (const Front& front : program_.fronts) {
      if (!front_shape(front).wide) {
        for (int i = 0; i < front.pivots * front.stride; ++i) mark(front.base + i);
      }
      for (int g = front.groups_begin; g < front.groups_end; ++g) {
        const Group& group = program_.groups[g];
        const int* places = program_.positions.data() + group.positions - group.begin;
        for (int k = group.begin; k < group.end; ++k) {
          const int column = group.base + (k - group.begin) * group.stride;
          for (int i = k; i < front.border; ++i) mark(column + places[i]);
        }
      }
    }
  }
  [[nodiscard]] std::vector<Range> ranges() const {
    std::vector<Range> all;
    for (int k = 0; k < static_cast<int>(is_changed_.size()); ++k) {
      if (!is_changed_[k]) continue;
      if (all.empty() || all.back().end != 8 * k) all.push_back({8 * k, 8 * k});
      all.back().end += 8;
    }
    return all;
  }

 private:
  void mark(int place) { is_changed_[place / 8] = true; }
  void couple(int p, int q, const std::vector<int>& sizes) {
    const int first = program_.row_of_node[p], other = program_.row_of_node[q];
    for (int i = first; i < first + sizes[p]; ++i) {
      for (int j = other; j < other + sizes[q]; ++j) {
        mark(program_.entry(std::max(i, j), std::min(i, j)));
      }
    }
  }

  const Program& program_;
  std::vector<bool> is_changed_;
};

}  // namespace

int Program::entry(int row, int column) const {
  const Front& front = fronts[front_of_row[column]];
  return front.base + (column - front.first) * front.stride + place_in(*this, front, row);
}

Program compile(const Pattern& pattern, int width, const Changing& changing) {
  Program program;
  program.width = width;
  const std::vector<int> sizes = sizes_of(pattern);
  Tree tree = best_tree(pattern, width);
  if (changing.numbers > 0) {
    program.constant_fronts =
        eliminate_points_first(pattern, width, changing, tree, program.inverts_points);
  }
  if (program.constant_fronts == 0) close_gaps(pattern, tree);
  program.cycles = tree.cycles;
  place_rows(tree, sizes, program);
  place_borders(tree, sizes, program);
  place_updates(program);
  if (width == 1) return program;
  Changes changes(program);
  // Those of points eliminated first are written as a whole.
  if (program.constant_fronts == 0) changes.of_elements(pattern, sizes);
  changes.of_fronts();
  program.changing = changes.ranges();
  return program;
}

FrontShape front_shape(const Front& front) {
  if (front.pivots > kPanel) return {(front.pivots - 1) % kPanel + 1, kPanel, true};
  return {front.pivots, front.border == 0 ? 0 : lanes_for(front.border), false};
}

}  // namespace mbs::compiled_ldl
