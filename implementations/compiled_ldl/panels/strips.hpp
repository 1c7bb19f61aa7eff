// What a front's border subtracts from later fronts, in strips of rows.
#pragma once

#include <algorithm>
#include <vector>

#include "panels/vectors.hpp"
#include "program.hpp"

namespace mbs::compiled_ldl {

/// Rows of a front's border that follow each other also in the columns that they go to, at most as
/// many as a register has lanes. Border rows 4, 5 and 9, of which a front with pivots 4, 5 and
/// border 8, 9 owns columns 4 and 5 and has the rows in places 0, 1 and 3: two strips for it, of
/// two rows and of one. Column 9 is another front's, with one strip.
struct Strip {
  int begin = 0, rows = 0;      // of the border
  int column = 0, columns = 0;  // of the border: what is updated
  int target = 0, stride = 0;   // storage of row `begin` in the first of these columns
};

/// Those of a front, behind `strips`; those of the same columns follow each other, and the last one
/// has all of these.
template <typename F>
void add_strips(const Program& program, const Front& front, std::vector<Strip>& strips) {
  const int most = front.border <= 4 ? lanes_for(front.border) : kWidest<F>;
  for (int g = front.groups_begin; g < front.groups_end; ++g) {
    const Group& group = program.groups[g];
    const int* places = program.positions.data() + group.positions - group.begin;
    for (int i = group.begin; i < front.border;) {
      Strip strip;
      strip.begin = i;
      while (i < front.border && i - strip.begin < most &&
             places[i] - places[strip.begin] == i - strip.begin) {
        ++i;
      }
      strip.rows = i - strip.begin;
      strip.column = group.begin;
      strip.columns = std::min(group.end, i) - group.begin;
      strip.target = group.base + places[strip.begin];
      strip.stride = group.stride;
      strips.push_back(strip);
    }
  }
}

}  // namespace mbs::compiled_ldl
