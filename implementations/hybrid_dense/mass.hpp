// Products with the mass matrix.
#pragma once

#include <vector>

#include "panels.hpp"
#include "slots.hpp"

namespace mbs::hybrid_dense {

/// M by rows of equally many entries; as a dense half where it is filled so far that this is
/// faster.
class Mass {
 public:
  Mass(const Model& model, const Slots& slots);

  /// y = M x.
  void multiply(const double* x, double* y) const;

 private:
  struct Group {  // rows of `length` entries
    int length, rows;
  };

  Panels panels_;
  Array dense_;  // empty: sparse
  std::vector<Group> groups_;
  std::vector<int> rows_, columns_;  // in the groups' order
  std::vector<double> values_;
};

}  // namespace mbs::hybrid_dense
