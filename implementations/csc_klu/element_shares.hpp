// What springs add to a matrix, (dt/2) C + (dt^2/4) K, and where it goes.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "element_blocks.hpp"
#include "forces.hpp"
#include "storage.hpp"

namespace mbs::csc_klu {

/// C and K on a pattern that has every block of them: for every pair of an element's ends which
/// gradients to multiply and where the values go.
template <int dim>
class ElementShares {
 public:
  ElementShares() = default;
  /// `is_written(p, q)`: block (p, q) has a value before add(), other than the constant one.
  ElementShares(const std::vector<ElementBlock>& elements, const Pattern& pattern,
                const std::function<bool(int, int)>& is_written);

  /// Adds dt/2 C + dt^2/4 K to `value`, where is_written() said no to `constant` instead; both have
  /// the entries of the pattern.
  void add(const Forces<dim>& forces, const double* constant, double* value) const;

 private:
  /// One product of the gradients of two ends.
  struct Share {
    int element, left, right;  ///< an element with C and K of a ForcePattern, and two of its ends
    double sign;               ///< what S S^T of Forces has there; 0 about an axis
    std::array<int, dim> columns;  ///< offset of the first row of each column of the block
  };

  std::vector<Share> first_;    ///< the first of each block that is not written
  std::vector<Share> further_;  ///< all others
};

}  // namespace mbs::csc_klu
