#include "schedule.hpp"

#include <algorithm>
#include <map>

namespace mbs::hybrid_dense {

Schedule::Schedule(const Model& model, std::span<const int> first, std::span<const int> slots,
                   std::span<const std::pair<int, int>> others, const Position& position) {
  std::map<std::pair<int, int>, std::vector<Pair>> products;  // by column and row, as M is sorted
  const auto is_free = [&](int slot) { return slot < model.variables(); };
  for (std::size_t k = 0; k + 1 < first.size(); ++k) {
    for (int left = first[k]; left < first[k + 1]; ++left) {
      for (int right = first[k]; right < first[k + 1]; ++right) {
        const int row = slots[left], column = slots[right];
        if (is_free(row) && row >= column) products[{column, row}].push_back({left, right});
      }
    }
  }
  for (const auto& [row, column] : others) products[{column, row}];

  std::vector<const std::pair<const std::pair<int, int>, std::vector<Pair>>*> sorted;
  for (const auto& item : products) sorted.push_back(&item);
  std::ranges::stable_sort(sorted, {}, [](const auto* item) { return item->second.size(); });
  const auto mass = model.mass();
  for (const auto* item : sorted) {
    const auto& [key, pairs] = *item;
    const auto found = std::ranges::lower_bound(
        mass, key, {}, [](const MassEntry& entry) { return std::pair(entry.col, entry.row); });
    const bool has_mass =
        found != mass.end() && found->col == key.first && found->row == key.second;
    const int count = static_cast<int>(pairs.size());
    if (groups_.empty() || groups_.back().products != count) groups_.push_back({count, 0});
    ++groups_.back().entries;
    entries_.push_back({position(key.second, key.first), has_mass ? found->value : 0.0});
    pairs_.insert(pairs_.end(), pairs.begin(), pairs.end());
  }
}

void Schedule::write_mass(const Model& model, const Position& position, double* T) {
  for (const MassEntry& entry : model.mass()) T[position(entry.row, entry.col)] = entry.value;
}

// 0 products: as many as the group says.
template <int Products>
void Schedule::assemble_group(const Group& group, double s, const double* Phi_q, double* T,
                              const Entry*& entry, const Pair*& pair) {
  const int products = Products > 0 ? Products : group.products;
  for (const Entry* const end = entry + group.entries; entry != end; ++entry) {
    double sum = 0.0;
    for (int k = 0; k < products; ++k) sum += Phi_q[pair[k].left] * Phi_q[pair[k].right];
    T[entry->position] = entry->mass + s * sum;
    pair += products;
  }
}

void Schedule::assemble(double s, const double* Phi_q, double* T) const {
  const Entry* entry = entries_.data();
  const Pair* pair = pairs_.data();
  for (const Group& group : groups_) {
    switch (group.products) {
      case 1:
        assemble_group<1>(group, s, Phi_q, T, entry, pair);
        break;
      case 2:
        assemble_group<2>(group, s, Phi_q, T, entry, pair);
        break;
      case 3:
        assemble_group<3>(group, s, Phi_q, T, entry, pair);
        break;
      case 4:
        assemble_group<4>(group, s, Phi_q, T, entry, pair);
        break;
      default:
        assemble_group<0>(group, s, Phi_q, T, entry, pair);
    }
  }
}

}  // namespace mbs::hybrid_dense
