// CHOLMOD: ordering, symbolic analysis, refactorization and solves without allocation.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pattern.hpp"

namespace mbs::csc_cholmod {

enum class Factorization {
  simplicial,  ///< entry by entry, up-looking, no BLAS
  supernodal,  ///< blocks of columns, left-looking, BLAS and LAPACK
};

/// How CHOLMOD is asked for it.
enum class Tuning {
  own,       ///< what was fastest here: README.md, "CHOLMOD's settings"
  amd,       ///< the same in AMD's order, supernodes of up to 16 columns
  metis,     ///< the same in that of METIS
  trees,     ///< the same in that of the simplicial code, by the lowest tree
  defaults,  ///< in AMD's order, supernodes as CHOLMOD merges them by itself
};

struct Method {
  Factorization factorization;
  Tuning tuning = Tuning::own;
};

/// The half that `factorization` reads without transposing it first.
Half preferred_half(Factorization factorization);

/// Fill-reducing order: unknown i becomes `result[i]`. AMD with a postorder of the elimination
/// tree; for the simplicial code the same fill by the lowest tree, or minimum degree in rounds, see
/// low_order(); for the supernodal code the model's own order where that should be faster.
/// Otherwise as tuned.
std::vector<int> fill_reducing_order(const HalfPattern& pattern, Method method);

/// Cholesky factorization of one symmetric matrix after the other, positive definite or (LDL')
/// quasi-definite, all of one pattern, which is expected in fill-reducing order already: CHOLMOD
/// then neither permutes nor copies the matrix.
class Solver {
 public:
  /// Analyses `pattern`, the preferred half of its factorization. `pattern` and `values` (which may
  /// change) must outlive this. `negative` lists the unknowns of the negative definite block.
  /// Throws Unsupported if CHOLMOD cannot hold the factor.
  Solver(Method method, const HalfPattern& pattern, const double* values,
         const std::vector<int>& negative = {});
  ~Solver();

  /// Factorizes the current values. False if a pivot is zero, NaN or of the wrong sign.
  [[nodiscard]] bool factorize();
  /// x (n) = the factorized matrix \ b (n). They may be the same. Throws std::bad_alloc.
  void solve(const double* b, double* x);

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
};

/// Version that the loaded library reports.
std::string library_version();

}  // namespace mbs::csc_cholmod
