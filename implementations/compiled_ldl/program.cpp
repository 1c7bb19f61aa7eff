// Compiles a pattern: the positions of everything in the fronts of its best tree.
#include "program.hpp"

#include <algorithm>

#include "best_tree.hpp"
#include "panels/vectors.hpp"

namespace mbs::compiled_ldl {
namespace {

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
