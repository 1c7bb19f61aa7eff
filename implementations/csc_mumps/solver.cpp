// The calls of MUMPS behind MultifrontalSolver; nobody else sees its header.
#include "solver.hpp"

#include <dmumps_c.h>

#include <limits>
#include <string>
#include <type_traits>

#include "mbs/simulation.hpp"

namespace mbs::csc_mumps {

static_assert(std::is_same_v<MUMPS_INT, int>);

namespace {

// Candidates for Mumps::amalgamation(): what MUMPS takes by itself, and two that merge more.
constexpr int kAmalgamations[] = {5, 24, 50};
// What a front and an operation cost, us; only their ratio matters.
constexpr double kFrontTime = 2.0;
constexpr double kOperationTime = 1e-4;

}  // namespace

/// MUMPS numbers jobs and controls; these are the names of those used here.
struct MultifrontalSolver::Mumps {
  enum Job { kEnd = -2, kStart = -1, kAnalyse = 1, kSolve = 3, kFactorizeAndSolve = 5 };
  enum Control {
    kErrorStream = 1,
    kDiagnosticStream = 2,
    kStatisticsStream = 3,
    kPrintLevel = 4,
    kOrdering = 7,
    kScaling = 8,
    kParallelRoot = 13,
  };
  static constexpr int kPositiveDefinite = 1;    // SYM
  static constexpr int kAllProcesses = -987654;  // the communicator; here, one process

  DMUMPS_STRUC_C structure{};

  void set(Control control, int value) { structure.icntl[control - 1] = value; }
  /// KEEP(1), internal to MUMPS: how readily the analysis merges a front with its parent.
  int& amalgamation() { return structure.keep[0]; }
  /// Estimates of the analysis: the number of fronts and the operations to eliminate in them.
  [[nodiscard]] int fronts() const { return structure.infog[5]; }
  [[nodiscard]] double operations() const { return structure.rinfog[0]; }
  [[nodiscard]] int error() const { return structure.infog[0]; }
  [[nodiscard]] int negative_pivots() const { return structure.infog[11]; }
  bool call(Job job) {
    structure.job = job;
    dmumps_c(&structure);
    return error() >= 0;
  }

  /// A fresh instance that prints nothing. Throws Unsupported if there is none to be had.
  static std::unique_ptr<Mumps, EndMumps> start() {
    auto fresh = std::make_unique<Mumps>();
    fresh->structure.sym = kPositiveDefinite;
    fresh->structure.par = 1;  // the host works, too
    fresh->structure.comm_fortran = kAllProcesses;
    if (!fresh->call(kStart)) throw Unsupported("MUMPS does not start");
    for (Control stream : {kErrorStream, kDiagnosticStream, kStatisticsStream, kPrintLevel}) {
      fresh->set(stream, 0);
    }
    return std::unique_ptr<Mumps, EndMumps>(fresh.release());
  }
};

void MultifrontalSolver::EndMumps::operator()(Mumps* mumps) const {
  mumps->call(Mumps::kEnd);
  delete mumps;
}

MultifrontalSolver::MultifrontalSolver(const LowerPattern& pattern, std::span<double> values)
    : mumps_(Mumps::start()) {
  irn_.reserve(pattern.row.size());
  jcn_.reserve(pattern.row.size());
  for (int column = 0; column < pattern.order(); ++column) {
    for (int k = pattern.start[column]; k < pattern.start[column + 1]; ++k) {
      irn_.push_back(pattern.row[k] + 1);
      jcn_.push_back(column + 1);
    }
  }
  mumps_->set(Mumps::kOrdering, 0);      // approximate minimum degree
  mumps_->set(Mumps::kScaling, 0);       // not needed without pivoting
  mumps_->set(Mumps::kParallelRoot, 1);  // the last front is no special case
  mumps_->structure.n = pattern.order();
  mumps_->structure.nnz = static_cast<MUMPS_INT8>(values.size());
  mumps_->structure.irn = irn_.data();
  mumps_->structure.jcn = jcn_.data();
  mumps_->structure.a = values.data();
  analyse();
}

/// Leaves the analysis whose factorization should be the fastest: few fronts against few
/// operations.
void MultifrontalSolver::analyse() {
  int best = kAmalgamations[0];
  double least = std::numeric_limits<double>::infinity();
  for (int candidate : kAmalgamations) {
    mumps_->amalgamation() = candidate;
    if (!mumps_->call(Mumps::kAnalyse)) continue;
    const double cost = kFrontTime * mumps_->fronts() + kOperationTime * mumps_->operations();
    if (cost >= least) continue;
    best = candidate;
    least = cost;
  }
  mumps_->amalgamation() = best;
  if (mumps_->call(Mumps::kAnalyse)) return;
  throw Unsupported("MUMPS refuses to analyse the pattern, error " +
                    std::to_string(mumps_->error()));
}

bool MultifrontalSolver::factorize_and_solve(std::span<double> x) {
  mumps_->structure.rhs = x.data();
  return mumps_->call(Mumps::kFactorizeAndSolve) && mumps_->negative_pivots() == 0;
}

bool MultifrontalSolver::solve(std::span<double> x) {
  mumps_->structure.rhs = x.data();
  return mumps_->call(Mumps::kSolve);
}

std::string MultifrontalSolver::version() { return Mumps::start()->structure.version_number; }

}  // namespace mbs::csc_mumps
