// The calls of UMFPACK, its settings, and what its statuses mean here.
#include "solver.hpp"

#include <umfpack.h>

#include <limits>
#include <string>

#include "mbs/simulation.hpp"

namespace mbs::csc_umfpack {
namespace {

/// In the model's order the fronts of a mechanism follow each other on a path, which pays as long
/// as it takes at most so many times the operations of AMD's order (README.md).
constexpr double kWorthOfPath = 2.0;

/// Multiplications that elimination in `order`, or that of the pattern, takes, which needs no
/// numbers: less than half of what UMFPACK counts.
double multiplications(const SparsityPattern& pattern, const std::vector<int>& order) {
  const int n = pattern.variables();
  std::vector<int> place(n), parent(n, -1), seen_from(n, -1), below(n);  // below: entries of L
  for (int k = 0; k < n; ++k) place[order.empty() ? k : order[k]] = k;
  for (int row = 0; row < n; ++row) {
    seen_from[row] = row;
    const int variable = order.empty() ? row : order[row];
    for (int k = pattern.starts[variable]; k < pattern.starts[variable + 1]; ++k) {
      for (int column = place[pattern.rows[k]]; column < row && seen_from[column] != row;
           column = parent[column]) {
        if (parent[column] < 0) parent[column] = row;
        seen_from[column] = row;
        ++below[column];
      }
    }
  }
  double sum = 0.0;
  for (const double entries : below) sum += entries * entries;
  return sum;
}

}  // namespace

static_assert(UMFPACK_CONTROL == 20 && UMFPACK_INFO == 90, "sizes of the arrays in solver.hpp");

void Solver::FreeSymbolic::operator()(void* symbolic) const { umfpack_di_free_symbolic(&symbolic); }

void Solver::FreeNumeric::operator()(void* numeric) const {
  const NumericMemory::Use use(*memory);
  umfpack_di_free_numeric(&numeric);
}

Solver::Solver(const SparsityPattern& pattern, Tuning tuning, const Orders& orders)
    : pattern_(pattern), integers_(pattern.variables()), reals_(5 * pattern.variables()) {
  tune(tuning);
  const auto take = [&](std::size_t order, int by_umfpack) {
    order < orders.size() ? analyse(UMFPACK_ORDERING_GIVEN, orders[order].data())
                          : analyse(by_umfpack, nullptr);
  };
  take(0, tuning == Tuning::metis ? UMFPACK_ORDERING_METIS : UMFPACK_ORDERING_AMD);
  if (tuning != Tuning::own) return;
  const double operations = count_operations();
  const std::vector<int>& path = orders.empty() ? std::vector<int>() : orders[1];
  if (multiplications(pattern, path) > kWorthOfPath * operations) return;
  take(1, UMFPACK_ORDERING_NONE);
  if (count_operations() > kWorthOfPath * operations) take(0, UMFPACK_ORDERING_AMD);
}

double Solver::count_operations() {
  std::vector<double> dominant(pattern_.rows.size(), 1.0);
  for (int column = 0; column < pattern_.variables(); ++column) {
    for (int k = pattern_.starts[column]; k < pattern_.starts[column + 1]; ++k) {
      if (pattern_.rows[k] == column) dominant[k] = pattern_.variables();
    }
  }
  const bool done = factorize(dominant.data());
  numeric_.reset();
  return done ? info_[UMFPACK_FLOPS] : std::numeric_limits<double>::infinity();
}

void Solver::tune(Tuning tuning) {
  umfpack_di_defaults(control_.data());
  control_[UMFPACK_PRL] = 0;
  if (tuning == Tuning::defaults) return;
  control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  // The diagonal will do as pivots, whatever the scale of rows.
  control_[UMFPACK_SYM_PIVOT_TOLERANCE] = 0.0;
  control_[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;
  control_[UMFPACK_BLOCK_SIZE] = 16;  // columns of a front that are put off; fronts are small here
  control_[UMFPACK_IRSTEP] = 0;
  control_[UMFPACK_ALLOC_INIT] = 1.0;  // less makes the saddle-point matrix reallocate every pass
}

void Solver::analyse(int ordering, const int* given) {
  control_[UMFPACK_ORDERING] = ordering;
  const int n = pattern_.variables();
  void* symbolic = nullptr;
  const int *starts = pattern_.starts.data(), *rows = pattern_.rows.data();
  const int status = given == nullptr
                         ? umfpack_di_symbolic(n, n, starts, rows, nullptr, &symbolic,
                                               control_.data(), info_.data())
                         : umfpack_di_qsymbolic(n, n, starts, rows, nullptr, given, &symbolic,
                                                control_.data(), info_.data());
  symbolic_.reset(symbolic);
  if (status != UMFPACK_OK) {
    throw Unsupported("UMFPACK refuses to analyse the matrix, status " + std::to_string(status));
  }
}

bool Solver::factorize(const double* A) {
  values_ = A;
  numeric_.reset();
  memory_.reset();
  const NumericMemory::Use use(memory_);
  void* numeric = nullptr;
  const int status = umfpack_di_numeric(pattern_.starts.data(), pattern_.rows.data(), A,
                                        symbolic_.get(), &numeric, control_.data(), info_.data());
  numeric_.reset(numeric);
  return status == UMFPACK_OK;  // UMFPACK_WARNING_singular_matrix is a failure too
}

void Solver::solve(const double* b, double* x) {
  // The matrix is for refinement, where there is any.
  umfpack_di_wsolve(UMFPACK_A, pattern_.starts.data(), pattern_.rows.data(), values_, x, b,
                    numeric_.get(), control_.data(), info_.data(), integers_.data(), reals_.data());
}

}  // namespace mbs::csc_umfpack
