// The only file that knows CHOLMOD.
#include "solver.hpp"

#include <cholmod.h>
#include <dlfcn.h>

#include <algorithm>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "elimination_order.hpp"
#include "mbs/simulation.hpp"

namespace mbs::csc_cholmod {
namespace {

/// LDL' saves the square roots; its factorization and solves together are the quicker ones.
constexpr int kSimplicialLl = 0;

/// Supernodes are merged up to so many columns whatever the zeros (README.md): fewer for mechanisms
/// with little fill, more where T fills.
constexpr std::size_t kMergedColumns[] = {16, 32};
// What a supernode and an operation cost, us; only their ratio matters.
constexpr double kSupernodeTime = 0.4;
constexpr double kOperationTime = 6e-5;

constexpr const char* kNoMemory = "CHOLMOD has no memory for the factor";

/// A quiet cholmod_common for one job at a time.
struct Common : cholmod_common {
  Common() {
    cholmod_start(this);
    print = 0;
    error_handler = nullptr;
    nmethods = 1;
    quick_return_if_not_posdef = 1;
    dtype = CHOLMOD_DOUBLE;
  }
  ~Common() { cholmod_finish(this); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
};

/// Whether parallel regions that begin on this thread are to be plain calls.
thread_local bool on_this_thread = false;

/// While it lives, parallel regions of the OpenMP runtime that CHOLMOD brought along, if any, run
/// on the calling thread. Its supernodal code asks for four threads by number, which no environment
/// variable but OMP_THREAD_LIMIT overrides; at these sizes they cost several times what they save.
class OneThread {
 public:
  OneThread() {
    on_this_thread = true;
    if (set_levels() != nullptr) {
      levels_ = get_levels()();
      set_levels()(0);
    }
  }
  ~OneThread() {
    if (set_levels() != nullptr) set_levels()(levels_);
    on_this_thread = false;
  }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  // Looked up by name: which runtime there is depends on how the library was built.
  using Get = int (*)();
  using Set = void (*)(int);
  static Get get_levels() {
    static const auto get = reinterpret_cast<Get>(dlsym(RTLD_DEFAULT, "omp_get_max_active_levels"));
    return get;
  }
  static Set set_levels() {
    static const auto set = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"));
    return get_levels() == nullptr ? nullptr : set;
  }

  int levels_ = 0;
};

/// CHOLMOD's header for a matrix whose arrays belong to `pattern` and `values`. Factorizations only
/// read them, although the header is not const.
cholmod_sparse view(const HalfPattern& pattern, const double* values) {
  cholmod_sparse matrix{};
  matrix.nrow = matrix.ncol = pattern.size();
  matrix.nzmax = pattern.nonzeros();
  matrix.p = const_cast<int*>(pattern.column_start().data());
  matrix.i = const_cast<int*>(pattern.row().data());
  matrix.x = const_cast<double*>(values);
  matrix.stype = pattern.half() == Half::lower ? -1 : 1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = matrix.packed = 1;
  return matrix;
}

cholmod_dense view(int n, double* values) {
  cholmod_dense vector{};
  vector.nrow = vector.nzmax = vector.d = n;
  vector.ncol = 1;
  vector.x = values;
  vector.xtype = CHOLMOD_REAL;
  vector.dtype = CHOLMOD_DOUBLE;
  return vector;
}

struct FreeFactor {
  cholmod_common* common = nullptr;  ///< outlives the factor
  void operator()(cholmod_factor* factor) const { cholmod_free_factor(&factor, common); }
};
using Factor = std::unique_ptr<cholmod_factor, FreeFactor>;

Factor analyze(cholmod_sparse& matrix, Common& common) {
  Factor factor(cholmod_analyze(&matrix, &common), {&common});
  if (factor != nullptr) return factor;
  throw Unsupported("CHOLMOD cannot analyse this matrix, status " + std::to_string(common.status));
}

/// What a supernodal factorization should take, us.
double expected_time(const cholmod_factor& factor) {
  const int* column = static_cast<const int*>(factor.super);
  const int* row = static_cast<const int*>(factor.pi);
  double operations = 0.0;
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const double columns = column[s + 1] - column[s], below = row[s + 1] - row[s] - columns;
    operations += columns * (columns * (columns / 3.0 + below) + below * below);
  }
  return kSupernodeTime * static_cast<double>(factor.nsuper) + kOperationTime * operations;
}

/// A supernodal analysis that merges supernodes up to so many columns, whatever zeros this stores.
Factor analyze_merging(cholmod_sparse& matrix, std::size_t columns, Common& common) {
  std::ranges::fill(common.nrelax, columns);
  return analyze(matrix, common);
}

/// expected_time() of an ordering, by the better of the numbers of columns to merge up to.
double least_time(const HalfPattern& pattern, int ordering) {
  Common common;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.method[0].ordering = ordering;
  cholmod_sparse matrix = view(pattern, nullptr);
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t columns : kMergedColumns) {
    least = std::min(least, expected_time(*analyze_merging(matrix, columns, common)));
  }
  return least;
}

std::vector<int> inverse(const int* permutation, int n) {
  std::vector<int> result(n);
  for (int k = 0; k < n; ++k) result[permutation[k]] = k;
  return result;
}

}  // namespace

Half preferred_half(Factorization factorization) {
  return factorization == Factorization::simplicial ? Half::upper : Half::lower;
}

std::vector<int> fill_reducing_order(const HalfPattern& pattern, Method method) {
  const bool supernodal = method.factorization == Factorization::supernodal;
  int ordering = method.tuning == Tuning::metis ? CHOLMOD_METIS : CHOLMOD_AMD;
  if (supernodal && method.tuning == Tuning::own &&
      least_time(pattern, CHOLMOD_NATURAL) < least_time(pattern, CHOLMOD_AMD)) {
    ordering = CHOLMOD_NATURAL;
  }
  Common common;
  common.supernodal = CHOLMOD_SIMPLICIAL;
  common.method[0].ordering = ordering;
  cholmod_sparse matrix = view(pattern, nullptr);
  Factor factor = analyze(matrix, common);
  const int n = pattern.size();
  const int* old = static_cast<const int*>(factor->Perm);
  if (supernodal ? method.tuning == Tuning::trees : method.tuning == Tuning::own) {
    std::vector<int> low = low_order(n, pattern.positions(), {old, old + n}, Before(n));
    if (!supernodal) return low;
    low = inverse(low.data(), n);
    common.method[0].ordering = CHOLMOD_GIVEN;  // and a postorder, of the same height
    factor.reset(cholmod_analyze_p(&matrix, low.data(), nullptr, 0, &common));
    if (factor == nullptr) throw Unsupported(kNoMemory);
    old = static_cast<const int*>(factor->Perm);
  }
  return inverse(old, n);
}

struct Solver::Cholmod {
  Cholmod(Method method, const HalfPattern& pattern, const double* values,
          const std::vector<int>& negative)
      : matrix(view(pattern, values)) {
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.postorder = 0;
    common.final_asis = 1;
    common.final_ll = kSimplicialLl;
    common.grow0 = common.grow1 = 0.0;  // columns of L never outgrow their exact space
    common.grow2 = 0;
    const bool supernodal = method.factorization == Factorization::supernodal;
    common.supernodal = supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    factor = method.tuning == Tuning::defaults || !supernodal
                 ? analyze(matrix, common)
                 : analyze_merging(matrix, kMergedColumns[0], common);
    if (supernodal && method.tuning == Tuning::own) merge_more();
    // Numeric space at once, so that no step pays for it: with to_packed = 0 a simplicial column
    // gets its exact size (by grow2), with 1 only its diagonal, and would move as it grows.
    if (!cholmod_change_factor(CHOLMOD_REAL, supernodal ? 1 : common.final_ll, supernodal, 0, 1,
                               factor.get(), &common)) {
      throw Unsupported(kNoMemory);
    }
    find_diagonal();
    split_diagonal(negative);
  }
  ~Cholmod() {
    cholmod_free_dense(&y, &common);
    cholmod_free_dense(&e, &common);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  /// Takes larger supernodes where they should be faster.
  void merge_more() {
    Factor larger = analyze_merging(matrix, kMergedColumns[1], common);
    if (expected_time(*larger) < expected_time(*factor)) factor = std::move(larger);
  }

  void find_diagonal() {
    if (!factor->is_super) {
      const int* start = static_cast<const int*>(factor->p);
      diagonal.assign(start, start + factor->n);
      inverse.resize(factor->n);
      return;
    }
    const int* first_column = static_cast<const int*>(factor->super);
    const int* rows = static_cast<const int*>(factor->pi);
    const int* values = static_cast<const int*>(factor->px);
    for (std::size_t s = 0; s < factor->nsuper; ++s) {
      const int stride = rows[s + 1] - rows[s] + 1;
      for (int j = 0; j < first_column[s + 1] - first_column[s]; ++j) {
        diagonal.push_back(values[s] + j * stride);
      }
    }
  }

  /// Moves the positions of the `negative` unknowns.
  void split_diagonal(const std::vector<int>& negative) {
    for (int k : negative) negative_diagonal.push_back(std::exchange(diagonal[k], -1));
    std::erase(diagonal, -1);
  }

  /// 1/D of LDL', which all solves with this factorization then multiply by.
  void invert_diagonal() {
    const double* x = static_cast<const double*>(factor->x);
    const int* start = static_cast<const int*>(factor->p);
    for (std::size_t j = 0; j < inverse.size(); ++j) inverse[j] = 1.0 / x[start[j]];
  }

  /// LDL': x = L' \ (D \ (L \ x)). A column of L has its diagonal, which is D's, first. Two
  /// columns with the same rows below both are taken together.
  void solve_in_place(double* x) const {
    const int n = static_cast<int>(factor->n);
    const int* start = static_cast<const int*>(factor->p);
    const int* count = static_cast<const int*>(factor->nz);
    const int* row = static_cast<const int*>(factor->i);
    const double* l = static_cast<const double*>(factor->x);
    const double* inverse_d = inverse.data();
    const auto is_pair = [&](int j) {  // j and j + 1
      return count[j] == count[j + 1] + 1 && row[start[j] + 1] == j + 1;
    };
    for (int j = 0; j < n; ++j) {
      const int* below = row + start[j] + 1;
      const double* first = l + start[j] + 1;
      const double x_j = x[j];
      if (j + 1 < n && is_pair(j)) {
        ++j;
        const double* second = l + start[j] + 1;
        const double x_next = x[j] -= *first++ * x_j;
        ++below;
        for (int p = 0; p < count[j] - 1; ++p) x[below[p]] -= first[p] * x_j + second[p] * x_next;
      } else {
        for (int p = 0; p < count[j] - 1; ++p) x[below[p]] -= first[p] * x_j;
      }
    }
    for (int j = n - 1; j >= 0; --j) {
      const int* below = row + start[j] + 1;
      const double* second = l + start[j] + 1;
      double sum = x[j] * inverse_d[j];
      if (j > 0 && is_pair(j - 1)) {
        const double* first = l + start[j - 1] + 2;
        double other = x[j - 1] * inverse_d[j - 1];
        for (int p = 0; p < count[j] - 1; ++p) {
          sum -= second[p] * x[below[p]];
          other -= first[p] * x[below[p]];
        }
        x[j] = sum;
        --j;
        x[j] = other - first[-1] * sum;
      } else {
        for (int p = 0; p < count[j] - 1; ++p) sum -= second[p] * x[below[p]];
        x[j] = sum;
      }
    }
  }

  Common common;
  cholmod_sparse matrix;
  Factor factor;
  std::vector<int> diagonal;  ///< positions of L's or D's positive diagonal in factor->x
  std::vector<int> negative_diagonal;
  std::vector<double> inverse;  ///< of D, for LDL'
  cholmod_dense* y = nullptr;   ///< workspace of cholmod_solve2, kept between calls
  cholmod_dense* e = nullptr;
};

Solver::Solver(Method method, const HalfPattern& pattern, const double* values,
               const std::vector<int>& negative)
    : cholmod_(std::make_unique<Cholmod>(method, pattern, values, negative)) {}

Solver::~Solver() = default;

bool Solver::factorize() {
  Cholmod& c = *cholmod_;
  std::optional<OneThread> one_thread;
  if (c.factor->is_super) one_thread.emplace();
  if (!cholmod_factorize(&c.matrix, c.factor.get(), &c.common) || c.common.status != CHOLMOD_OK) {
    return false;
  }
  // LDL' does not stop at a pivot of the wrong sign, and no comparison of CHOLMOD's stops at a NaN.
  const double* x = static_cast<const double*>(c.factor->x);
  int good = 1;
  for (int d : c.diagonal) good &= x[d] > 0.0;
  for (int d : c.negative_diagonal) good &= x[d] < 0.0;
  c.invert_diagonal();
  return good != 0;
}

void Solver::solve(const double* b, double* x) {
  Cholmod& c = *cholmod_;
  const int n = static_cast<int>(c.factor->n);
  if (!c.factor->is_super) {
    if (x != b) std::copy_n(b, n, x);
    c.solve_in_place(x);
    return;
  }
  cholmod_dense right = view(n, const_cast<double*>(b));
  cholmod_dense solution = view(n, x);
  cholmod_dense* handle = &solution;  // of the right shape, so solve2 keeps it
  if (!cholmod_solve2(CHOLMOD_A, c.factor.get(), &right, nullptr, &handle, nullptr, &c.y, &c.e,
                      &c.common)) {
    throw std::bad_alloc();  // its workspace, in the first call
  }
}

std::string library_version() {
  int version[3];
  cholmod_version(version);
  return std::to_string(version[0]) + "." + std::to_string(version[1]) + "." +
         std::to_string(version[2]);
}

}  // namespace mbs::csc_cholmod

/// What GCC's OpenMP runtime enters a parallel region by, in front of its own: for a team of one
/// that wakes waiting threads, of which there are none, by a system call at each region's end. The
/// supernodal code has a region or two per supernode. Whoever else calls it gets the runtime's own.
extern "C" [[gnu::visibility("default")]] void GOMP_parallel(void (*region)(void*), void* data,
                                                             unsigned threads, unsigned flags) {
  static const auto runtime =
      reinterpret_cast<decltype(&GOMP_parallel)>(dlsym(RTLD_NEXT, "GOMP_parallel"));
  if (mbs::csc_cholmod::on_this_thread || runtime == nullptr) return region(data);
  runtime(region, data, threads, flags);
}
