// Which blocks of T the springs couple, found once.
#include "element_blocks.hpp"

#include <algorithm>
#include <tuple>

namespace mbs::csc_klu {

std::vector<ElementBlock> element_blocks(const ForcePattern& forces, int dim) {
  std::vector<ElementBlock> blocks;
  const int lines = forces.lines();
  const std::vector<int> ends = forces.stiff_ends();
  int begin = 0;
  for (int element = 0; element < std::ssize(ends); ++element) {
    for (int right = begin; right < ends[element]; ++right) {
      for (int left = begin; left < ends[element]; ++left) {
        const MovedPoint &row = forces.ends[left], &col = forces.ends[right];
        const double sign = element < lines ? row.first * col.first : 0.0;
        blocks.push_back({row.coordinate / dim, col.coordinate / dim, element, left, right, sign});
      }
    }
    begin = ends[element];
  }
  std::ranges::stable_sort(blocks, {},
                           [](const ElementBlock& block) { return std::tuple(block.q, block.p); });
  return blocks;
}

}  // namespace mbs::csc_klu
