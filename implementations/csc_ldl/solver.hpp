// SuiteSparse's LDL: L D L^T of a symmetric matrix, row by row of L, without pivoting.
#pragma once

#include <string>
#include <vector>

namespace mbs::csc_ldl {

/// Of LDL's header; the library itself does not tell.
std::string ldl_version();

/// The upper triangle of a symmetric matrix in compressed sparse columns, rows ascending.
struct UpperPattern {
  int size = 0;
  std::vector<int> begin, row;  ///< size + 1: where a column begins in `row`
};

/// One factorization, refreshed in place. Storage is made with the object.
class LdlSolver {
 public:
  LdlSolver() = default;
  /// `sign`: of what sign each pivot has to be, 1.0 or -1.0.
  LdlSolver(UpperPattern pattern, std::vector<double> sign);

  /// The entries of the pattern, to be written before factorize(), which leaves them alone.
  [[nodiscard]] std::vector<double>& values() { return values_; }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// False if a pivot is zero, NaN or of the wrong sign.
  [[nodiscard]] bool factorize();
  /// x is the right-hand side when it arrives.
  void solve(double* x) const;

 private:
  UpperPattern pattern_;
  std::vector<double> values_, sign_;
  std::vector<int> L_begin_, parent_, L_count_, L_row_, stack_, flag_;  // as ldl.h wants them
  std::vector<double> L_, D_, row_, inverse_D_;
};

}  // namespace mbs::csc_ldl
