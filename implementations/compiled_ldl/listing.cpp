// The listing: the fronts of a program one by one.
#include "listing.hpp"

#include <algorithm>
#include <cstdlib>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "scene.hpp"
#include "simulations.hpp"

namespace mbs::compiled_ldl {
namespace listing {

/// Ascending numbers, those that follow each other as a range: "0-3 6".
std::string ranges(std::span<const int> numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (!text.empty()) text += ' ';
    text += std::to_string(numbers[i]);
    if (last > i) text += '-' + std::to_string(numbers[last]);
    i = last + 1;
  }
  return text.empty() ? "none" : text;
}

std::string range(int first, int count) {
  const std::string begin = std::to_string(first);
  return count == 1 ? begin : begin + '-' + std::to_string(first + count - 1);
}

/// What begins at each row: a point's name or the number of a multiplier. Empty: neither does.
std::vector<std::string> names_of_rows(const Model& model, const Program& program) {
  std::vector<std::string> names(program.size);
  int node = 0;
  for (const Point& point : model.points()) {
    if (!point.is_fixed()) names[program.row_of_node[node++]] = point.name;
  }
  const int points = node;
  for (; node < static_cast<int>(program.row_of_node.size()); ++node) {
    names[program.row_of_node[node]] = "lambda[" + std::to_string(node - points) + ']';
  }
  return names;
}

std::span<const int> border_of(const Program& program, const Front& front) {
  return {program.border_rows.data() + front.rows, static_cast<std::size_t>(front.border)};
}

/// A front's parent in the elimination tree is the one with the first row of its border.
std::vector<int> levels_of(const Program& program) {
  std::vector<int> levels(program.fronts.size(), 0);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    if (program.fronts[k].border == 0) continue;
    int& parent = levels[program.front_of_row[border_of(program, program.fronts[k])[0]]];
    parent = std::max(parent, levels[k] + 1);
  }
  return levels;
}

void print_updates(std::ostream& out, const Program& program, const Front& front) {
  const auto border = border_of(program, front);
  for (int g = front.groups_begin; g < front.groups_end; ++g) {
    const Group& group = program.groups[g];
    const std::size_t count = border.size() - group.begin;
    out << "        update of border " << ranges(border.subspan(group.begin)) << " into columns "
        << range(border[group.begin], group.end - group.begin) << " of front "
        << program.front_of_row[border[group.begin]] << ", places "
        << ranges({program.positions.data() + group.positions, count}) << '\n';
  }
}

/// Runs are counted over all fronts: those of one shape that follow each other.
struct Runs {
  FrontShape shape;
  int count = 0;

  void print(std::ostream& out, const Front& front) {
    const FrontShape next = front_shape(front);
    if (count == 0 || next != shape) ++count;
    shape = next;
    out << "; panels ";
    if (shape.wide) out << (front.pivots - 1) / kPanel << " of " << kPanel << "x8 and ";
    out << shape.pivots << 'x' << shape.lanes << " in run " << count - 1;
  }
};

void print_fronts(std::ostream& out, const Model& model, const Program& program) {
  const auto names = names_of_rows(model, program);
  const auto levels = levels_of(program);
  Runs runs;
  for (std::size_t k = 0; k < program.fronts.size(); ++k) {
    const Front& front = program.fronts[k];
    out << "front " << k << ", level " << levels[k] << ": pivots "
        << range(front.first, front.pivots) << " (";
    const char* between = "";
    for (int row = front.first; row < front.first + front.pivots; ++row) {
      if (names[row].empty()) continue;
      out << between << names[row];
      between = ", ";
    }
    out << "), border " << ranges(border_of(program, front)) << '\n'
        << "        storage " << range(front.base, front.pivots * front.stride) << ", columns "
        << front.stride << " apart";
    runs.print(out, front);
    out << '\n';
    print_updates(out, program, front);
  }
}

}  // namespace listing

bool is_listing_due() {
  static bool printed = false;
  const char* asked = std::getenv("COMPILED_LDL_PRINT");
  if (printed || asked == nullptr || *asked == '\0') return false;
  return printed = true;
}

void list_fronts(std::ostream& out, const Model& model, const StepSettings& settings) {
  const Program program = program_of(model, settings, 8);
  const bool doubles = settings.precision == Precision::double_precision;
  const std::size_t bytes = program.storage * (doubles ? sizeof(double) : sizeof(float));
  const auto points = std::count_if(model.points().begin(), model.points().end(),
                                    [](const Point& point) { return !point.is_fixed(); });
  if (doubles && create_small(model, settings)) {
    out << "A small scene: in these settings its step is one dense matrix, not this program.\n";
  }
  out << "compiled_ldl/fronts: storage of " << program.storage << " numbers (" << bytes
      << " bytes); " << program.size << " rows, points " << points << ", multipliers "
      << program.row_of_node.size() - points << ", fronts " << program.fronts.size();
  if (program.constant_fronts > 0) {
    out << ", the first " << program.constant_fronts << " factorized once";
  }
  out << "; predicted cycles of a factorization " << static_cast<long>(program.cycles)
      << ".\nA panel PxL has P pivots, and the rows below are taken L at a time.\n";
  listing::print_fronts(out, model, program);
}

}  // namespace mbs::compiled_ldl
