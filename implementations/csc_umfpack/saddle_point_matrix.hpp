// The matrix of Eq. (12): what is known of it before any value is, and its values.
#pragma once

#include <array>
#include <vector>

#include "assembly.hpp"
#include "coupling.hpp"
#include "forces.hpp"
#include "jacobian.hpp"
#include "pattern.hpp"
#include "solver.hpp"

namespace mbs::csc_umfpack {

/// The pattern of [T_0 Phi_q^T; Phi_q -epsilon], both triangles, coordinates before multipliers,
/// and where the values that change go.
template <int D>
struct SaddlePointSchedule {
  /// Where a block of Phi_q is.
  struct Block {
    int column = 0;               ///< of Phi_q^T: D numbers from here
    std::array<int, D> row = {};  ///< of Phi_q
  };

  SaddlePointSchedule(const MassMatrix& mass, const JacobianLayout& layout,
                      const ForceLayout& forces, Tuning tuning);

  SparsityPattern pattern;
  Orders orders;                   ///< of elimination
  std::vector<Block> blocks;       ///< of Phi_q, in the order in which it is written
  std::vector<Place<D>> places;    ///< of the elements, see element_places()
  std::vector<int> with_elements;  ///< positions that elements add to, each once

 private:
  SaddlePointSchedule(const MassMatrix& mass, const JacobianLayout& layout,
                      const ForceLayout& forces, Tuning tuning, const Lists& rows);
};

/// The values of Eq. (12). The entries of M that no element reaches, linear rows and -epsilon are
/// written once, at construction.
template <int D>
class SaddlePointMatrix {
 public:
  /// `epsilon` is 4 / (alpha Delta t^2).
  SaddlePointMatrix(const MassMatrix& mass, const JacobianLayout& layout, const ForceLayout& forces,
                    double epsilon, Tuning tuning);

  [[nodiscard]] const SparsityPattern& pattern() const { return schedule_.pattern; }
  [[nodiscard]] const Orders& orders() const { return schedule_.orders; }
  [[nodiscard]] const double* values() const { return values_.data(); }

  void update(const Jacobian<D>& jacobian, const Forces<D>& forces);

 private:
  SaddlePointSchedule<D> schedule_;
  std::vector<double> values_;
  std::vector<double> constant_;  ///< M where elements add to it
};

}  // namespace mbs::csc_umfpack
