// The calls of MUMPS behind MultifrontalSolver.
#include "solver.hpp"

#include <array>
#include <limits>
#include <utility>

#include "mumps.hpp"
#include "orders.hpp"

namespace mbs::csc_mumps {

namespace {

// Candidates for Mumps::amalgamation(): what MUMPS takes by itself, and two that merge more.
constexpr int kAmalgamations[] = {5, 24, 50};
// What a front and an operation cost, us; only their ratio matters.
constexpr double kFrontTime = 2.0;
constexpr double kOperationTime = 1e-4;
// Of quasi-definite matrices; README.md, "The order of the saddle-point matrix".
constexpr double kPivotThreshold = 1e-4;
constexpr int kMostSlack = 100000;  // percent

}  // namespace

void MultifrontalSolver::EndMumps::operator()(Mumps* mumps) const {
  mumps->call(Mumps::kEnd);
  delete mumps;
}

MultifrontalSolver::MultifrontalSolver(Triplets pattern, std::span<double> values, Tuning tuning)
    : pattern_(std::move(pattern)), mumps_(Mumps::start(Mumps::kPositiveDefinite)) {
  share(values);
  switch (tuning) {
    case Tuning::own:
      analyse(std::array<int, 2>{Mumps::kMinimumDegree, Mumps::kMinimumFill});
      break;
    case Tuning::amd:
      analyse(std::array<int, 1>{Mumps::kMinimumDegree});
      break;
    case Tuning::scotch:
      analyse(std::array<int, 1>{Mumps::kScotch});
      break;
    case Tuning::metis:
    case Tuning::trees:
      position_ = positions(pattern_, tuning);
      mumps_->structure.perm_in = position_.data();
      analyse(std::array<int, 1>{Mumps::kGivenOrder});
      break;
    case Tuning::defaults:
      mumps_->set(Mumps::kScaling, Mumps::kAutomaticScaling);
      mumps_->analyse();
      break;
  }
}

MultifrontalSolver::MultifrontalSolver(Triplets pattern, std::span<double> values,
                                       std::vector<int> position)
    : pattern_(std::move(pattern)),
      position_(std::move(position)),
      mumps_(Mumps::start(Mumps::kGeneralSymmetric)) {
  mumps_->set(Mumps::kTransversal, 0);        // rows stay where they are
  mumps_->set(Mumps::kSymmetricStrategy, 1);  // the order is that of single variables
  mumps_->threshold() = kPivotThreshold;
  mumps_->structure.perm_in = position_.data();
  share(values);
  analyse(std::array<int, 1>{Mumps::kGivenOrder});
}

void MultifrontalSolver::share(std::span<double> values) {
  mumps_->set(Mumps::kScaling, 0);       // none
  mumps_->set(Mumps::kParallelRoot, 1);  // the last front is no special case
  mumps_->structure.n = pattern_.order;
  mumps_->structure.nnz = static_cast<MUMPS_INT8>(values.size());
  mumps_->structure.irn = pattern_.row.data();
  mumps_->structure.jcn = pattern_.column.data();
  mumps_->structure.a = values.data();
}

/// Leaves the analysis whose factorization should be the fastest: few fronts against few
/// operations.
void MultifrontalSolver::analyse(std::span<const int> orderings) {
  std::pair best(orderings[0], kAmalgamations[0]);
  double least = std::numeric_limits<double>::infinity();
  const auto choose = [this](int ordering, int amalgamation) {
    mumps_->set(Mumps::kOrdering, ordering);
    mumps_->amalgamation() = amalgamation;
  };
  for (const int ordering : orderings) {
    for (const int amalgamation : kAmalgamations) {
      choose(ordering, amalgamation);
      if (!mumps_->call(Mumps::kAnalyse)) continue;
      const double cost = kFrontTime * mumps_->fronts() + kOperationTime * mumps_->operations();
      if (cost >= least) continue;
      best = {ordering, amalgamation};
      least = cost;
    }
  }
  choose(best.first, best.second);
  mumps_->analyse();
  if (mumps_->ordering() != best.first) throw Unsupported("MUMPS was built without this order");
}

bool MultifrontalSolver::factorize_and_solve(std::span<double> x) {
  const int slack = mumps_->slack();
  mumps_->structure.rhs = x.data();
  while (!mumps_->call(Mumps::kFactorizeAndSolve)) {
    if (!mumps_->ran_out_of_slack() || mumps_->slack() > kMostSlack) {
      mumps_->slack() = slack;  // a singular matrix puts off all its pivots, the next one few
      return false;
    }
    mumps_->slack() *= 2;  // pivots that were put off fill more than the analysis has foreseen
  }
  return !mumps_->must_be_positive() || mumps_->negative_pivots() == 0;
}

bool MultifrontalSolver::solve(std::span<double> x) {
  mumps_->structure.rhs = x.data();
  return mumps_->call(Mumps::kSolve);
}

std::vector<int> MultifrontalSolver::positions(Triplets pattern, Tuning tuning) {
  if (tuning == Tuning::metis) return metis_positions(pattern);
  if (tuning == Tuning::trees) return low_tree_positions(pattern);
  const auto mumps = Mumps::start(Mumps::kPositiveDefinite);
  mumps->set(Mumps::kOrdering, tuning == Tuning::scotch ? Mumps::kScotch : Mumps::kMinimumDegree);
  mumps->structure.n = pattern.order;
  mumps->structure.nnz = static_cast<MUMPS_INT8>(pattern.row.size());
  mumps->structure.irn = pattern.row.data();
  mumps->structure.jcn = pattern.column.data();
  mumps->analyse();
  return {mumps->structure.sym_perm, mumps->structure.sym_perm + pattern.order};
}

std::string MultifrontalSolver::version() {
  return Mumps::start(Mumps::kPositiveDefinite)->structure.version_number;
}

}  // namespace mbs::csc_mumps
