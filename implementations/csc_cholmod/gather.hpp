// Sums of values picked through recorded indices: how Phi_q^T x and Phi_q^T Phi_q are formed.
#pragma once

#include <vector>

namespace mbs::csc_cholmod {

/// One summand: values[source] goes into result[target].
struct Contribution {
  int target = 0;
  int source = 0;
};

/// Immutable schedule of  result[t] = base[t] + sum of the values that go into t,  for every t that
/// some value goes into. Targets with equally many summands stand together, so that the loop over
/// the summands has a fixed length and no branch of the sum depends on data.
///
/// Example, contributions (5,0) (2,1) (5,2): the group of one is target 2 <- {1}, the group of two
/// is target 5 <- {0, 2}; other targets are never touched.
class GatherSchedule {
 public:
  explicit GatherSchedule(const std::vector<Contribution>& contributions);

  /// `result` may be `base` and must not overlap `values`.
  void sum(const double* base, const double* values, double* result) const;

 private:
  struct Group {
    int summands = 0;  ///< of each target
    int targets = 0;
  };
  std::vector<Group> groups_;
  std::vector<int> target_;  ///< group after group, ascending in each
  std::vector<int> source_;  ///< `summands` for each target, in the same order
};

}  // namespace mbs::csc_cholmod
