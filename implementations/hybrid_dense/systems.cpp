#include "systems.hpp"

#include "solver.hpp"

namespace mbs::hybrid_dense {
namespace {

// Rows become columns: each round deals the rows out like two halves of a pack of cards.
[[gnu::always_inline]] inline void transpose(Vec (&x)[kWidth]) {
  for (int round = 1; round < kWidth; round *= 2) {
    Vec y[kWidth];
    for (int i = 0; i < kWidth / 2; ++i) {
#ifdef __AVX512F__
      y[2 * i] = __builtin_shufflevector(x[i], x[i + 4], 0, 8, 1, 9, 2, 10, 3, 11);
      y[2 * i + 1] = __builtin_shufflevector(x[i], x[i + 4], 4, 12, 5, 13, 6, 14, 7, 15);
#else
      y[2 * i] = __builtin_shufflevector(x[i], x[i + 2], 0, 4, 1, 5);
      y[2 * i + 1] = __builtin_shufflevector(x[i], x[i + 2], 2, 6, 3, 7);
#endif
    }
    for (int i = 0; i < kWidth; ++i) x[i] = y[i];
  }
}

// y = R x. R: `count` rows, rounded up to whole vectors, each of `columns`, which are whole
// vectors.
void multiply(const double* R, long count, long columns, const double* x, double* y) {
  for (long k = 0; k < count; k += kWidth) {
    const double* rows = R + k * columns;
    Vec products[kWidth] = {};
    for (long j = 0; j < columns; j += kWidth) {
      const Vec factor = load(x + j);
      for (int r = 0; r < kWidth; ++r) products[r] += load(rows + r * columns + j) * factor;
    }
    store(y + k, sums(products));
  }
}

// x -= R^T y
void subtract_rows(const double* R, long count, long columns, const double* y, double* x) {
  for (long k = 0; k < count; k += kWidth) {
    const double* rows = R + k * columns;
    for (long j = 0; j < columns; j += kWidth) {
      Vec sum = load(x + j);
      for (int r = 0; r < kWidth; ++r) sum -= broadcast(y[k + r]) * load(rows + r * columns + j);
      store(x + j, sum);
    }
  }
}

}  // namespace

template <int D, class Solver>
SaddleSystem<D, Solver>::SaddleSystem(const Model& model, const Slots& slots,
                                      const Constraints<D>& constraints, Forces<D>& forces,
                                      const StepSettings& settings)
    : constraints_(constraints),
      forces_(forces),
      n_(slots.n),
      m_(model.constraints()),
      total_(slots.total),
      epsilon_(4 / (settings.penalty * settings.step * settings.step)),
      T_0_(n_),
      S_(m_),
      schedule_(model, {}, {}, forces.tangent_entries(),
                [this](long i, long j) { return T_0_.position(i, j); }),
      inverse_((forces.in_tangent() ? padded(m_) : total_) * padded(n_)),
      product_(total_ * padded(m_)),
      z_(total_),
      z_y_(padded(m_)) {
  const Schedule::Position position = [this](long i, long j) { return T_0_.position(i, j); };
  Schedule::write_mass(model, position, T_0_.matrix());
  forces.schedule(position);
  if (!forces.in_tangent()) invert();
}

// T_0 is well conditioned where masses are, and Cholesky does not mind their scale.
template <int D, class Solver>
void SaddleSystem<D, Solver>::invert() {
  for (long j = 0; j < n_; ++j) inverse_[j * padded(n_) + j] = 1.0;
  regular_ = T_0_.factorize();
  if (regular_) T_0_.solve(inverse_.data(), n_, padded(n_));
}

template <int D, class Solver>
void SaddleSystem<D, Solver>::solve_rows() {
  const auto first = constraints_.firsts();
  const auto slots = constraints_.slots();
  std::fill_n(inverse_.data(), m_ * padded(n_), 0.0);
  for (long row = 0; row < m_; ++row) {
    for (int e = first[row]; e < first[row + 1]; ++e) {
      if (slots[e] < n_) inverse_[row * padded(n_) + slots[e]] += Phi_q_[e];
    }
  }
  regular_ = T_0_.factorize();
  if (!regular_) return;
  if constexpr (Solver::kProducts) {
    T_0_.multiply(inverse_.data(), m_, padded(n_), S_);
  } else {
    T_0_.solve(inverse_.data(), m_, padded(n_));
    multiply_rows();
  }
}

template <int D, class Solver>
void SaddleSystem<D, Solver>::assemble(const double* Phi_q) {
  Phi_q_ = Phi_q;
  if (forces_.in_tangent()) {
    schedule_.assemble(0.0, Phi_q, T_0_.matrix());
    forces_.add_tangent(T_0_.matrix());
    solve_rows();
  }
  if (!regular_) return;
  if (!forces_.in_tangent()) multiply_rows();
  for (long k = 0; k < m_; ++k) S_.matrix()[S_.position(k, k)] += epsilon_;
}

template <int D, class Solver>
void SaddleSystem<D, Solver>::multiply_rows() {
  const auto first = constraints_.firsts();
  const auto slots = constraints_.slots();
  const long columns = padded(n_);
  for (long p = 0; p < m_; p += kWidth) {
    double* product = product_.data() + p * total_;
    const long rows = std::min<long>(kWidth, m_ - p);
    for (long j = 0; j < columns; j += kWidth) {
      Vec sums[kWidth] = {};
      for (long r = 0; r < rows; ++r) {
        if (forces_.in_tangent()) {
          sums[r] = load(inverse_.data() + (p + r) * columns + j);
          continue;
        }
        for (int e = first[p + r]; e < first[p + r + 1]; ++e) {
          sums[r] += broadcast(Phi_q_[e]) * load(inverse_.data() + slots[e] * columns + j);
        }
      }
      transpose(sums);
      for (int t = 0; t < kWidth; ++t) store(product + (j + t) * kWidth, sums[t]);
    }
    for (long l = 0; l < p + rows; ++l) {
      Vec sum = {};
      for (int e = first[l]; e < first[l + 1]; ++e) {
        sum += broadcast(Phi_q_[e]) * load(product + slots[e] * kWidth);
      }
      store(S_.matrix() + S_.position(p, l), sum);
    }
  }
}

template <int D, class Solver>
bool SaddleSystem<D, Solver>::factorize() {
  return regular_ && S_.factorize();
}

template <int D, class Solver>
void SaddleSystem<D, Solver>::solve(double* x, double* y) {
  const double* rows = inverse_.data();
  std::fill(x + n_, x + padded(n_), 0.0);  // a lost step may have left NaN
  if (!forces_.in_tangent()) {
    multiply(rows, n_, padded(n_), x, z_.data());
    constraints_.multiply(Phi_q_, z_.data(), z_y_.data());
  } else {
    // Rows are Phi_q L^-T where there are products, so that L is needed once, else Phi_q T_0^-1.
    if constexpr (Solver::kProducts) T_0_.solve_lower(x);
    multiply(rows, m_, padded(n_), x, z_y_.data());
    if constexpr (!Solver::kProducts) T_0_.solve(x);
  }
  solve_schur(x, y);
}

template <int D, class Solver>
void SaddleSystem<D, Solver>::solve_constraints(double* x, double* y) {
  std::fill_n(x, padded(n_), 0.0);
  std::fill_n(z_y_.data(), m_, 0.0);
  solve_schur(x, y);
}

// z_y_ is Phi_q T_0^-1 r_1 and y is r_2 when they arrive. x is r_1; with springs L^-1 r_1 or
// T_0^-1 r_1.
template <int D, class Solver>
void SaddleSystem<D, Solver>::solve_schur(double* x, double* y) {
  const double* rows = inverse_.data();
  for (long k = 0; k < m_; ++k) z_y_[k] -= y[k];
  std::fill(z_y_.data() + m_, z_y_.data() + padded(m_), 0.0);  // as above
  S_.solve(z_y_.data());
  std::copy_n(z_y_.data(), m_, y);
  if (forces_.in_tangent()) {
    subtract_rows(rows, m_, padded(n_), z_y_.data(), x);
    if constexpr (Solver::kProducts) T_0_.solve_upper(x);
    return;
  }
  for (long k = 0; k < m_; ++k) z_y_[k] = -y[k];
  constraints_.add_forces(Phi_q_, z_y_.data(), x);
  multiply(rows, n_, padded(n_), x, z_.data());
  std::copy_n(z_.data(), n_, x);
}

template class SaddleSystem<2, LltSolver>;
template class SaddleSystem<2, PotrfSolver>;
template class SaddleSystem<2, PanelsSolver>;
template class SaddleSystem<3, LltSolver>;
template class SaddleSystem<3, PotrfSolver>;
template class SaddleSystem<3, PanelsSolver>;

}  // namespace mbs::hybrid_dense
