// Names for the jobs and controls of MUMPS that are used here; only solver.cpp includes this.
#pragma once

#include <dmumps_c.h>

#include <memory>
#include <string>
#include <type_traits>

#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_mumps {

static_assert(std::is_same_v<MUMPS_INT, int>);

struct MultifrontalSolver::Mumps {
  enum Job { kEnd = -2, kStart = -1, kAnalyse = 1, kSolve = 3, kFactorizeAndSolve = 5 };
  enum Control {
    kErrorStream = 1,
    kDiagnosticStream = 2,
    kStatisticsStream = 3,
    kPrintLevel = 4,
    kTransversal = 6,
    kOrdering = 7,
    kScaling = 8,
    kSymmetricStrategy = 12,
    kParallelRoot = 13,
    kSlack = 14,  // percent of memory more than the analysis expects
  };
  enum Kind { kPositiveDefinite = 1, kGeneralSymmetric = 2 };
  enum Ordering { kMinimumDegree = 0, kGivenOrder = 1, kMinimumFill = 2, kScotch = 3 };
  static constexpr int kAutomaticScaling = 77;
  static constexpr int kAllProcesses = -987654;  // the communicator; here, one process

  DMUMPS_STRUC_C structure{};

  void set(Control control, int value) { structure.icntl[control - 1] = value; }
  int& slack() { return structure.icntl[kSlack - 1]; }
  /// CNTL(1): a pivot is at least so much of the largest entry of its column.
  double& threshold() { return structure.cntl[0]; }
  /// KEEP(1), internal to MUMPS: how readily the analysis merges a front with its parent.
  int& amalgamation() { return structure.keep[0]; }

  /// The ordering that the analysis took: another one where MUMPS was built without that asked for.
  [[nodiscard]] int ordering() const { return structure.infog[6]; }
  /// Estimates of the analysis: the number of fronts and the operations to eliminate in them.
  [[nodiscard]] int fronts() const { return structure.infog[5]; }
  [[nodiscard]] double operations() const { return structure.rinfog[0]; }
  [[nodiscard]] int error() const { return structure.infog[0]; }
  [[nodiscard]] bool ran_out_of_slack() const { return error() == -8 || error() == -9; }
  [[nodiscard]] bool must_be_positive() const { return structure.sym == kPositiveDefinite; }
  [[nodiscard]] int negative_pivots() const { return structure.infog[11]; }

  bool call(Job job) {
    structure.job = job;
    dmumps_c(&structure);
    return error() >= 0;
  }

  /// A fresh instance that prints nothing. Throws Unsupported if there is none to be had.
  static std::unique_ptr<Mumps, EndMumps> start(Kind kind) {
    auto fresh = std::make_unique<Mumps>();
    fresh->structure.sym = kind;
    fresh->structure.par = 1;  // the host works, too
    fresh->structure.comm_fortran = kAllProcesses;
    if (!fresh->call(kStart)) throw Unsupported("MUMPS does not start");
    for (Control stream : {kErrorStream, kDiagnosticStream, kStatisticsStream, kPrintLevel}) {
      fresh->set(stream, 0);
    }
    return std::unique_ptr<Mumps, EndMumps>(fresh.release());
  }

  /// Analyses or throws Unsupported.
  void analyse() {
    if (call(kAnalyse)) return;
    throw Unsupported("MUMPS refuses to analyse the pattern, error " + std::to_string(error()));
  }
};

}  // namespace mbs::csc_mumps
