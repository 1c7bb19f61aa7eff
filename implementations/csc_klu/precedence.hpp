// Which columns of a matrix have to be eliminated before which others.
#pragma once

#include <vector>

namespace mbs::csc_klu {

/// Vertices of a graph, some of which have to wait until others have been taken out.
///
///   Precedence precedence(3);
///   precedence.add(0, 2);
///   precedence.is_free(2);                         // false
///   precedence.take_out(0, [](int freed) { ... });  // calls it with 2
class Precedence {
 public:
  explicit Precedence(int vertices) : waiting_(vertices), missing_(vertices, 0) {}

  /// `later` waits for `earlier`; repetitions do no harm.
  void add(int earlier, int later) {
    waiting_[earlier].push_back(later);
    ++missing_[later];
  }
  [[nodiscard]] bool is_free(int vertex) const { return missing_[vertex] == 0; }

  /// Takes a vertex out and calls visit(u) for every u that has become free.
  template <class Visit>
  void take_out(int vertex, Visit visit) {
    for (const int later : waiting_[vertex]) {
      if (--missing_[later] == 0) visit(later);
    }
  }

 private:
  std::vector<std::vector<int>> waiting_;  ///< by vertex: those that wait for it
  std::vector<int> missing_;               ///< by vertex: for how many it still waits
};

}  // namespace mbs::csc_klu
