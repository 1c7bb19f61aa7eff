// Set-up: calls AMD and merges the multipliers into its order.
#include "elimination_order.hpp"

#include <amd.h>

#include <algorithm>
#include <span>
#include <string>

#include "mbs/simulation.hpp"

namespace mbs::csc_umfpack {

std::vector<int> elimination_order(const SparsityPattern& T, const Lists& rows,
                                   const Lists& owned) {
  const int n = T.variables();
  std::vector<int> coordinates(n);
  const int status =
      amd_order(n, T.starts.data(), T.rows.data(), coordinates.data(), nullptr, nullptr);
  if (status != AMD_OK) {
    throw Unsupported("AMD cannot order the tangent matrix, status " + std::to_string(status));
  }
  std::vector<int> places(n);
  for (int k = 0; k < n; ++k) places[coordinates[k]] = k + 1;
  const auto last_place = [&places](std::span<const int> some) {
    int last = 0;
    for (const int coordinate : some) last = std::max(last, places[coordinate]);
    return last;
  };
  std::vector<int> owner(n, -1), all;  // all: for every row, the place of its last coordinate, or 0
  for (int row = 0; row < rows.count(); ++row) {
    for (const int coordinate : owned[row]) owner[coordinate] = row;
    all.push_back(last_place(rows[row]));
  }
  Lists last;  // for every row, the place after which its multiplier can follow; 0: at once
  for (int row = 0; row < rows.count(); ++row, last.end_list()) {
    int place = all[row];
    for (const int coordinate : rows[row]) {
      if (owner[coordinate] >= 0) place = std::max(place, all[owner[coordinate]]);
    }
    last.items.push_back(owned[row].empty() ? place : last_place(owned[row]));
  }
  const Lists ready = transpose(last, n + 1);
  std::vector<int> order;
  for (int place = 0; place <= n; ++place) {
    if (place > 0) order.push_back(coordinates[place - 1]);
    for (const int row : ready[place]) order.push_back(n + row);
  }
  return order;
}

}  // namespace mbs::csc_umfpack
