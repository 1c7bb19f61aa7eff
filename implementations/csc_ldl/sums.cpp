// Sums of contributions: lists made once, then one loop for each number of parts.
#include "sums.hpp"

#include <algorithm>
#include <map>

namespace mbs::csc_ldl {

void Sums::finish() {
  std::ranges::stable_sort(pairs_, {}, &std::pair<int, int>::first);
  std::map<int, std::vector<int>> by_parts;  // number of parts -> index_ of its run
  for (std::size_t first = 0; first < pairs_.size();) {
    std::size_t last = first;
    while (last < pairs_.size() && pairs_[last].first == pairs_[first].first) ++last;
    std::vector<int>& run = by_parts[static_cast<int>(last - first)];
    run.push_back(pairs_[first].first);
    for (; first < last; ++first) run.push_back(pairs_[first].second);
  }
  for (const auto& [parts, run] : by_parts) {
    runs_.push_back({parts, static_cast<int>(run.size()) / (parts + 1)});
    index_.insert(index_.end(), run.begin(), run.end());
  }
  pairs_ = {};
}

void Sums::apply(const double* from, const double* part, double* to) const {
  const int* index = index_.data();
  for (const Run& run : runs_) {
    with_constant(run.parts, [&](auto parts) {
      for (int target = 0; target < run.targets; ++target, index += parts + 1) {
        double sum = from[index[0]];
        for (int k = 1; k <= parts; ++k) sum += part[index[k]];
        to[index[0]] = sum;
      }
    });
  }
}

}  // namespace mbs::csc_ldl
