// Calls of MUMPS: set-up of one instance, JOB = 1 (analysis), 5 (2 and 3 in one) and 3 (solution).
#include "solver.hpp"

#include <dmumps_c.h>

#include <string>
#include <type_traits>

#include "mbs/simulation.hpp"

namespace mbs::starting_sparse {
namespace {

static_assert(std::is_same_v<MUMPS_INT, int>, "coordinate lists are handed over without a copy");

constexpr int kWholeWorld = -987654;   // MUMPS's communicator "all processes": here, the only one
constexpr int kGeneralSymmetric = 2;   // SYM: indefinite, pivots of order one and two as in MA27
constexpr int kIntegersTooSmall = -8;  // INFOG(1): delayed pivots outgrew the estimated integers
constexpr int kRealsTooSmall = -9;     // INFOG(1): ... the estimated reals
constexpr int kLargestRelaxation = 4000;  // per cent; where the workspace is no longer doubled

}  // namespace

struct Solver::Instance {
  DMUMPS_STRUC_C data{};

  /// Element k of the control array, numbered from 1 as in the manual of MUMPS.
  int& icntl(int k) { return data.icntl[k - 1]; }
  /// Runs one job; returns INFOG(1), negative for a failure.
  int run(int job) {
    data.job = job;
    dmumps_c(&data);
    return data.infog[0];
  }
  /// Inertia of the last factorization, INFOG(12).
  [[nodiscard]] int negative_pivots() const { return data.infog[11]; }
};

void Solver::TerminateInstance::operator()(Instance* instance) const {
  instance->run(-2);
  delete instance;
}

/// A fresh instance that prints nothing, owned from here on.
Solver::Handle Solver::initialize() {
  auto instance = std::make_unique<Instance>();
  instance->data.par = 1;  // the host works, too
  instance->data.sym = kGeneralSymmetric;
  instance->data.comm_fortran = kWholeWorld;
  if (instance->run(-1) < 0) throw Unsupported("MUMPS cannot be initialised");
  for (int stream : {1, 2, 3, 4}) instance->icntl(stream) = 0;
  return Handle(instance.release());
}

Solver::Solver(const CoordinateMatrix& matrix) : mumps_(initialize()) {
  mumps_->icntl(6) = 0;   // no permutation to a full diagonal
  mumps_->icntl(7) = 0;   // approximate minimum degree
  mumps_->icntl(8) = 0;   // no scaling, as in MA27
  mumps_->icntl(12) = 1;  // ordering of the matrix as it is
  mumps_->icntl(13) = 1;  // last front like any other

  // The interface of MUMPS knows no const; without a permutation it only reads these arrays.
  mumps_->data.n = matrix.order;
  mumps_->data.nnz = static_cast<MUMPS_INT8>(matrix.values.size());
  mumps_->data.irn = const_cast<int*>(matrix.rows.data());
  mumps_->data.jcn = const_cast<int*>(matrix.columns.data());
  mumps_->data.a = const_cast<double*>(matrix.values.data());
  const int outcome = mumps_->run(1);
  if (outcome < 0) {
    throw Unsupported("analysis by MUMPS failed: INFOG(1) = " + std::to_string(outcome));
  }
}

bool Solver::factorize_and_solve(double* x) {
  const int margin = mumps_->icntl(14);
  mumps_->data.rhs = x;  // untouched as long as the factorization fails
  int outcome = mumps_->run(5);
  while ((outcome == kIntegersTooSmall || outcome == kRealsTooSmall) &&
         mumps_->icntl(14) < kLargestRelaxation) {
    mumps_->icntl(14) *= 2;
    outcome = mumps_->run(5);
  }
  if (outcome < 0) mumps_->icntl(14) = margin;  // a singular matrix delays all its pivots
  return outcome >= 0 && mumps_->negative_pivots() == 0;
}

bool Solver::solve(double* x) {
  mumps_->data.rhs = x;
  return mumps_->run(3) >= 0;
}

std::string Solver::library_version() { return initialize()->data.version_number; }

}  // namespace mbs::starting_sparse
