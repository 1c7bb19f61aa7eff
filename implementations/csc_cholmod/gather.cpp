// Sorts contributions into groups at set-up and runs over them in the step.
#include "gather.hpp"

#include <algorithm>
#include <numeric>

namespace mbs::csc_cholmod {
namespace {

template <int kSummands>
void sum_group(int targets, const int* target, const int* source, const double* base,
               const double* __restrict values, double* result) {
  for (int e = 0; e < targets; ++e, source += kSummands) {
    double sum = base[target[e]];
    for (int k = 0; k < kSummands; ++k) sum += values[source[k]];
    result[target[e]] = sum;
  }
}

void sum_group(int summands, int targets, const int* target, const int* source, const double* base,
               const double* __restrict values, double* result) {
  for (int e = 0; e < targets; ++e, source += summands) {
    double sum = base[target[e]];
    for (int k = 0; k < summands; ++k) sum += values[source[k]];
    result[target[e]] = sum;
  }
}

}  // namespace

GatherSchedule::GatherSchedule(const std::vector<Contribution>& contributions) {
  int size = 0;
  for (const Contribution& c : contributions) size = std::max(size, c.target + 1);
  std::vector<int> start(size + 1);
  for (const Contribution& c : contributions) ++start[c.target + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> source(contributions.size());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (const Contribution& c : contributions) source[next[c.target]++] = c.source;

  for (int t = 0; t < size; ++t) {
    if (start[t + 1] > start[t]) target_.push_back(t);
  }
  const auto summands = [&](int t) { return start[t + 1] - start[t]; };
  std::stable_sort(target_.begin(), target_.end(),
                   [&](int s, int t) { return summands(s) < summands(t); });
  source_.reserve(source.size());
  for (int t : target_) {
    if (groups_.empty() || groups_.back().summands != summands(t)) groups_.push_back({summands(t)});
    ++groups_.back().targets;
    source_.insert(source_.end(), source.begin() + start[t], source.begin() + start[t + 1]);
  }
}

void GatherSchedule::sum(const double* base, const double* values, double* result) const {
  const int* target = target_.data();
  const int* source = source_.data();
  for (const Group& g : groups_) {
    switch (g.summands) {
      case 1:
        sum_group<1>(g.targets, target, source, base, values, result);
        break;
      case 2:
        sum_group<2>(g.targets, target, source, base, values, result);
        break;
      case 3:
        sum_group<3>(g.targets, target, source, base, values, result);
        break;
      case 4:
        sum_group<4>(g.targets, target, source, base, values, result);
        break;
      default:
        sum_group(g.summands, g.targets, target, source, base, values, result);
    }
    target += g.targets;
    source += static_cast<std::ptrdiff_t>(g.summands) * g.targets;
  }
}

}  // namespace mbs::csc_cholmod
