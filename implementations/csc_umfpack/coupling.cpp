// Set-up: sets of coordinates from the layouts, places of blocks from a pattern.
#include "coupling.hpp"

#include <algorithm>

namespace mbs::csc_umfpack {
namespace {

void add_point(int offset, int dimension, Lists& sets) {
  for (int k = 0; k < dimension; ++k) sets.items.push_back(offset + k);
}

}  // namespace

template <int D>
Place<D>::Place(const SparsityPattern& pattern, int row, int col) {
  for (int k = 0; k < D; ++k) {
    position[k] = pattern.position(row, col + k);
    mirrored[k] = pattern.position(col, row + k);
  }
}

std::vector<std::span<const PointLayout::Signs>> elements(const ForceLayout& forces) {
  std::vector<std::span<const PointLayout::Signs>> result;
  const auto add = [&](const auto& element) {
    result.push_back(std::span(forces.ends).subspan(element.first, element.last - element.first));
  };
  std::ranges::for_each(forces.springs, add);
  std::ranges::for_each(forces.torsion_springs, add);
  return result;
}

Lists row_coordinates(const JacobianLayout& layout, int dimension) {
  Lists sets;
  const auto end_row = [&] {
    std::sort(sets.items.begin() + sets.starts.back(), sets.items.end());
    sets.end_list();
  };
  const int block_rows = layout.rows() - static_cast<int>(layout.linears.size());
  auto block = layout.blocks.begin();
  for (int row = 0; row < block_rows; ++row) {
    for (; block != layout.blocks.end() && block->row == row; ++block) {
      add_point(block->offset, dimension, sets);
    }
    end_row();
  }
  for (const auto& linear : layout.linears) {
    for (int t = linear.first; t < linear.last; ++t) {
      sets.items.push_back(layout.terms[t].coordinate);
    }
    end_row();
  }
  return sets;
}

void add_element_coordinates(const ForceLayout& forces, int dimension, Lists& sets) {
  for (const auto& element : elements(forces)) {
    for (const auto& end : element) add_point(end.offset, dimension, sets);
    sets.end_list();
  }
}

template <int D>
std::vector<Place<D>> element_places(const SparsityPattern& pattern, const ForceLayout& forces) {
  std::vector<Place<D>> places;
  for (const auto& ends : elements(forces)) {
    for (auto i = ends.begin(); i != ends.end(); ++i) {
      for (auto j = ends.begin(); j != i + 1; ++j) {
        places.push_back({pattern, i->offset, j->offset});
      }
    }
  }
  return places;
}

template struct Place<2>;
template struct Place<3>;
template std::vector<Place<2>> element_places<2>(const SparsityPattern&, const ForceLayout&);
template std::vector<Place<3>> element_places<3>(const SparsityPattern&, const ForceLayout&);

}  // namespace mbs::csc_umfpack
