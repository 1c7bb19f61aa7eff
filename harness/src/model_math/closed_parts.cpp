// Matching, what is reached from unmatched columns, strongly connected components.
#include "model_math/closed_parts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "model_math/connected_parts.hpp"
#include "model_math/jacobian_rank.hpp"
#include "model_math/kinematics.hpp"

namespace mbs {
namespace {

using Lists = std::vector<std::vector<int>>;

/// Phi_q as a bipartite graph with a matching of its rows.
class Pattern {
 public:
  Pattern(int rows, int cols)
      : cols_of_(static_cast<std::size_t>(rows)),
        rows_of_(static_cast<std::size_t>(cols)),
        col_of_(cols_of_.size(), -1),
        row_of_(rows_of_.size(), -1) {}

  void add(int row, int col) {
    cols_of_[at(row)].push_back(col);
    rows_of_[at(col)].push_back(row);
  }

  /// Gives as many rows as possible a column of their own.
  void match() {
    std::vector<int> seen(rows_of_.size(), -1);
    for (int row = 0; row < static_cast<int>(cols_of_.size()); ++row) augment(row, seen);
  }

  /// The columns that are reached from unmatched ones by rows and their columns, as a flag each.
  [[nodiscard]] std::vector<bool> loose() const {
    std::vector<bool> reached(rows_of_.size(), false);
    std::vector<int> stack;
    for (std::size_t col = 0; col < row_of_.size(); ++col) {
      if (row_of_[col] < 0) stack.push_back(static_cast<int>(col));
    }
    while (!stack.empty()) {
      const auto col = at(stack.back());
      stack.pop_back();
      if (reached[col]) continue;
      reached[col] = true;
      for (const int row : rows_of_[col]) {
        if (col_of_[at(row)] >= 0) stack.push_back(col_of_[at(row)]);
      }
    }
    return reached;
  }

  /// The rows of the columns that `loose` leaves, in strongly connected groups: a row leads to
  /// those whose columns it has [Tarjan, 1972]. A group comes after those that its rows lead to.
  [[nodiscard]] Lists groups(const std::vector<bool>& loose) const {
    Lists result;
    std::vector<int> index(cols_of_.size(), -1), low(index), path;
    std::vector<bool> on_path(index.size(), false);
    std::vector<std::pair<int, std::size_t>>
        open;  // a row, its next column: no recursion over chains
    int count = 0;
    const auto begin = [&](int row) {
      index[at(row)] = low[at(row)] = count++;
      path.push_back(row);
      on_path[at(row)] = true;
      open.emplace_back(row, 0);
    };
    const auto end = [&](int row) {
      if (!open.empty()) {
        int& before = low[at(open.back().first)];
        before = std::min(before, low[at(row)]);
      }
      if (low[at(row)] != index[at(row)]) return;
      result.emplace_back();
      for (int top = -1; top != row;) {
        top = path.back();
        path.pop_back();
        on_path[at(top)] = false;
        result.back().push_back(top);
      }
    };
    for (int first = 0; first < static_cast<int>(cols_of_.size()); ++first) {
      if (is_tight(first, loose) && index[at(first)] < 0) begin(first);
      while (!open.empty()) {
        const int row = open.back().first;
        const std::size_t place = open.back().second++;
        if (place == cols_of_[at(row)].size()) {
          open.pop_back();
          end(row);
          continue;
        }
        const int next = row_of_[at(cols_of_[at(row)][place])];
        if (next < 0 || next == row) continue;
        if (index[at(next)] < 0) {
          begin(next);
        } else if (on_path[at(next)]) {
          low[at(row)] = std::min(low[at(row)], index[at(next)]);
        }
      }
    }
    return result;
  }

  /// Takes off what hangs on the rest: rows with two columns or more that are in no other row.
  void take_off_hanging() {
    std::vector<int> uses(rows_of_.size());
    for (std::size_t col = 0; col < uses.size(); ++col) {
      uses[col] = static_cast<int>(rows_of_[col].size());
    }
    const auto is_own = [&](int col) { return uses[at(col)] == 1; };
    std::vector<int> stack(cols_of_.size());
    std::iota(stack.begin(), stack.end(), 0);
    while (!stack.empty()) {
      const int row = stack.back();
      stack.pop_back();
      if (std::ranges::count_if(cols_of_[at(row)], is_own) < 2) continue;
      for (const int col : std::exchange(cols_of_[at(row)], {})) {
        --uses[at(col)];
        std::erase(rows_of_[at(col)], row);
        for (const int next : rows_of_[at(col)]) stack.push_back(next);
      }
    }
  }

  /// The loose columns in groups that share rows.
  [[nodiscard]] std::vector<ConstraintBlock> pieces(const std::vector<bool>& loose) const {
    std::vector<ConstraintBlock> result;
    std::vector<bool> has_col(rows_of_.size(), false), has_row(cols_of_.size(), false);
    for (std::size_t first = 0; first < loose.size(); ++first) {
      if (!loose[first] || has_col[first]) continue;
      ConstraintBlock piece;
      std::vector<int> stack{static_cast<int>(first)};
      has_col[first] = true;
      while (!stack.empty()) {
        const int col = stack.back();
        stack.pop_back();
        piece.cols.push_back(col);
        for (const int row : rows_of_[at(col)]) {
          if (has_row[at(row)]) continue;
          has_row[at(row)] = true;
          piece.rows.push_back(row);
          for (const int next : cols_of_[at(row)]) {
            if (!loose[at(next)] || has_col[at(next)]) continue;
            has_col[at(next)] = true;
            stack.push_back(next);
          }
        }
      }
      result.push_back(std::move(piece));
    }
    return result;
  }

  [[nodiscard]] int col_of(int row) const { return col_of_[at(row)]; }
  /// The rows whose columns a row has.
  [[nodiscard]] std::vector<int> rows_needed(int row) const {
    std::vector<int> result;
    for (const int col : cols_of_[at(row)]) {
      if (row_of_[at(col)] >= 0) result.push_back(row_of_[at(col)]);
    }
    return result;
  }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  [[nodiscard]] bool is_tight(int row, const std::vector<bool>& loose) const {
    return col_of_[at(row)] >= 0 && !loose[at(col_of_[at(row)])];
  }

  bool augment(int row, std::vector<int>& seen) {
    // Depth first, without recursion over whole chains: breadth first with parents.
    std::vector<std::pair<int, int>> queue;  // row, place of its parent
    std::vector<int> via;                    // the column by which it was found
    queue.emplace_back(row, -1);
    via.push_back(-1);
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (const int col : cols_of_[at(queue[i].first)]) {
        if (seen[at(col)] == row) continue;
        seen[at(col)] = row;
        if (row_of_[at(col)] >= 0) {
          queue.emplace_back(row_of_[at(col)], static_cast<int>(i));
          via.push_back(col);
          continue;
        }
        int free = col;
        for (int k = static_cast<int>(i); k >= 0; k = queue[at(k)].second) {
          const int owner = queue[at(k)].first;
          col_of_[at(owner)] = free;
          row_of_[at(free)] = owner;
          free = via[at(k)];
        }
        return true;
      }
    }
    return false;
  }

  Lists cols_of_, rows_of_;
  std::vector<int> col_of_, row_of_;  // the matching; -1: none
};

ConstraintBlock sorted(ConstraintBlock block) {
  std::ranges::sort(block.rows);
  std::ranges::sort(block.cols);
  return block;
}

/// The groups of `rows` rows, each with those that it needs; without those that need more than
/// `most` rows.
std::vector<ClosedParts::Driven> driven_parts(const Pattern& pattern, const Lists& groups, int rows,
                                              std::size_t most) {
  std::vector<ClosedParts::Driven> result;
  std::vector<std::size_t> group_of(static_cast<std::size_t>(rows));
  std::vector<std::set<std::size_t>> needed(groups.size());  // itself too; empty: too many rows
  std::vector<ConstraintBlock> blocks;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    ConstraintBlock& block = blocks.emplace_back();
    for (const int row : groups[g]) {
      group_of[static_cast<std::size_t>(row)] = g;
      block.rows.push_back(row);
      block.cols.push_back(pattern.col_of(row));
    }
    block = sorted(std::move(block));
    std::set<std::size_t> mine{g};
    bool is_known = true;
    for (const int row : groups[g]) {
      for (const int other : pattern.rows_needed(row)) {
        const std::size_t its = group_of[static_cast<std::size_t>(other)];
        if (its == g) continue;
        if (needed[its].empty()) is_known = false;
        mine.insert(needed[its].begin(), needed[its].end());
      }
    }
    std::size_t count = 0;
    for (const std::size_t its : mine) count += blocks[its].rows.size();
    if (!is_known || count > most) continue;
    ClosedParts::Driven& driven = result.emplace_back();
    driven.block = block;
    for (const std::size_t its : mine) {
      driven.needed.push_back(blocks[its]);
      std::ranges::copy(blocks[its].rows, std::back_inserter(driven.all.rows));
      std::ranges::copy(blocks[its].cols, std::back_inserter(driven.all.cols));
    }
    driven.all = sorted(std::move(driven.all));
    needed[g] = std::move(mine);
  }
  return result;
}

}  // namespace

ClosedParts closed_parts(const Model& model, const std::vector<double>& q, int largest) {
  ClosedParts result;
  const int rows = model.constraints(), cols = model.variables();
  result.freedoms = cols;
  const auto entries = jacobian(model, 0.0, q);
  const auto rank = find_rank(rows, cols, entries);
  ConnectedParts connected(model);
  std::vector<int> freedoms(model.points().size() + 1);  // of each part
  const auto part_of = [&](int col) { return static_cast<std::size_t>(connected.part_of(col)); };
  for (int col = 0; col < cols; ++col) ++freedoms[part_of(col)];
  int row = -1;
  for (const JacobianEntry& entry : entries) {
    if (rank && entry.row != row && !std::ranges::binary_search(rank->dependent, entry.row))
      --freedoms[part_of(entry.col)];
    row = entry.row;
  }
  for (int col = 0; col < cols; ++col) result.passes_on.push_back(freedoms[part_of(col)] > 1);
  if (rows == 0 || !rank) return result;
  result.freedoms = cols - rank->rank;
  Pattern pattern(rows, cols);
  std::vector<bool> has_redundant(freedoms.size());
  for (const JacobianEntry& entry : entries) {
    if (std::ranges::binary_search(rank->dependent, entry.row)) {
      has_redundant[part_of(entry.col)] = true;
    } else {
      pattern.add(entry.row, entry.col);
    }
  }
  for (int col = 0; col < cols; ++col)
    result.has_redundant_rows.push_back(has_redundant[part_of(col)]);
  pattern.match();
  const auto loose = pattern.loose();
  const auto most = static_cast<std::size_t>(largest);
  if (is_driven(model)) result.driven = driven_parts(pattern, pattern.groups(loose), rows, most);
  pattern.take_off_hanging();
  // What a spring ties to a loop is no part of it: its own freedoms pass energy on as before.
  ConnectedParts rigid(model, false);
  const auto rigid_part_of = [&](int col) { return static_cast<std::size_t>(rigid.part_of(col)); };
  std::vector<bool> has_loop(freedoms.size());
  for (ConstraintBlock& piece : pattern.pieces(loose)) {
    const std::size_t size = piece.rows.size();
    if (size == 0 || size > most || piece.cols.size() != size + 1) continue;
    if (size > 1) has_loop[rigid_part_of(piece.cols.front())] = true;
    result.free.push_back(sorted(std::move(piece)));
  }
  for (int col = 0; col < cols; ++col) {
    if (has_loop[rigid_part_of(col)]) result.passes_on[static_cast<std::size_t>(col)] = false;
  }
  return result;
}

}  // namespace mbs
