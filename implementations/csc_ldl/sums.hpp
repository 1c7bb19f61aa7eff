// Sums of contributions at places that setup finds once: how all sparse things are assembled here.
#pragma once

#include <type_traits>
#include <utility>
#include <vector>

namespace mbs::csc_ldl {

/// Calls f with `count`, up to 8 as a constant, so that its loops are unrolled.
template <class Function>
void with_constant(int count, Function f) {
  switch (count) {
    case 1:
      return f(std::integral_constant<int, 1>{});
    case 2:
      return f(std::integral_constant<int, 2>{});
    case 3:
      return f(std::integral_constant<int, 3>{});
    case 4:
      return f(std::integral_constant<int, 4>{});
    case 5:
      return f(std::integral_constant<int, 5>{});
    case 6:
      return f(std::integral_constant<int, 6>{});
    case 7:
      return f(std::integral_constant<int, 7>{});
    case 8:
      return f(std::integral_constant<int, 8>{});
    default:
      return f(count);
  }
}

/// Lists of contributions by target. Targets of equally many are one run of one tight loop, and a
/// target without any costs nothing.
///
/// Example: add(0, 3), add(5, 1), add(5, 2) makes to[0] = from[0] + part[3] and
/// to[5] = from[5] + part[1] + part[2].
class Sums {
 public:
  void add(int target, int part) { pairs_.emplace_back(target, part); }
  /// After the last add().
  void finish();

  [[nodiscard]] bool empty() const { return runs_.empty(); }
  /// `from` and `to` may be the same.
  void apply(const double* from, const double* part, double* to) const;

 private:
  struct Run {
    int parts, targets;
  };
  std::vector<std::pair<int, int>> pairs_;
  std::vector<Run> runs_;
  std::vector<int> index_;  // of each target: itself, then its parts
};

}  // namespace mbs::csc_ldl
