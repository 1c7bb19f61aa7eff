// The mass matrix as an operator on a vector.
#pragma once

#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_ldl {

/// M, both halves, rows of equally many entries in one run of one tight loop.
class Mass {
 public:
  /// `place` says where the state has a coordinate of the model.
  Mass(std::span<const MassEntry> entries, const std::vector<int>& place);

  /// y = M x.
  void multiply(const double* x, double* y) const;

 private:
  struct Run {
    int entries, rows;
  };
  std::vector<Run> runs_;
  std::vector<int> row_, col_;  // run by run
  std::vector<double> value_;
};

}  // namespace mbs::csc_ldl
