// The vectors that a multistep method looks back to, and its formulas on whole vectors.
#pragma once

#include <array>
#include <cmath>
#include <vector>

namespace mbs::csc_klu {

/// The last five vectors of a sequence, in a ring: nothing is moved.
class History {
 public:
  static constexpr int kLength = 5;

  explicit History(int n) { vectors_.fill(std::vector<double>(n, 0.0)); }

  /// That of j steps ago, 1 to 5; 0 is the one to be written, in the place of 5.
  [[nodiscard]] double* back(int j) { return vectors_[place(j)].data(); }
  [[nodiscard]] const double* back(int j) const { return vectors_[place(j)].data(); }
  void advance() { present_ = place(-1); }

 private:
  [[nodiscard]] int place(int j) const { return (present_ + kLength - j) % kLength; }

  std::array<std::vector<double>, kLength> vectors_;
  int present_ = 0;
};

inline constexpr double kLeading = 3331.0 / 2400.0;  ///< b_0 of Eq. (17)

/// Predicts a_n, and w_n (each n) by Eq. (17), for a step of `h`, s.
inline void extrapolate(int n, double h, History& moves, History& accelerations) {
  constexpr double b1 = -73.0 / 300.0, b2 = 3133.0 / 1200.0;
  const double* __restrict const w1 = moves.back(1);
  const double* __restrict const w2 = moves.back(2);
  const double* __restrict const w3 = moves.back(3);
  const double* __restrict const w4 = moves.back(4);
  const double* __restrict const a1 = accelerations.back(1);
  const double* __restrict const a2 = accelerations.back(2);
  const double* __restrict const a3 = accelerations.back(3);
  const double* __restrict const a4 = accelerations.back(4);
  double* __restrict const w = moves.back(0);
  double* __restrict const a = accelerations.back(0);
  for (int i = 0; i < n; ++i) {
    const double a0 = 5.0 * (a1[i] - a4[i]) - 10.0 * (a2[i] - a3[i]) + a[i];
    const double push = kLeading * (a0 + a4[i]) + b1 * (a1[i] + a3[i]) + b2 * a2[i];
    w[i] += 0.1 * (w1[i] - w4[i]) - 0.2 * (w2[i] - w3[i]) + h * h * push;  // Eq. (17)
    a[i] = a0;
  }
}

/// Adds an increment of q' (n) to w_n and, times `per_push` = 1/(b_0 dt^2), to a_n too; true if it
/// is within the tolerance, which no NaN is.
inline bool correct_last(int n, double tolerance, double per_push,
                         const double* __restrict increment, double* __restrict q,
                         double* __restrict w, double* __restrict a) {
  long long beyond = 0;
  for (int i = 0; i < n; ++i) {
    beyond |= !(std::abs(increment[i]) <= tolerance);
    q[i] += increment[i];
    w[i] += increment[i];
    a[i] += per_push * increment[i];
  }
  return beyond == 0;
}

/// The velocity (n) at the end of the last step, exact for accelerations of fourth degree.
inline void differentiate(int n, double h, const History& moves, const History& accelerations,
                          double* v) {
  constexpr double d[] = {475.0 / 288.0, -247.0 / 90.0, 631.0 / 240.0, -58.0 / 45.0,
                          367.0 / 1440.0};
  const double* const w = moves.back(1);
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    for (int j = 0; j < History::kLength; ++j) sum += d[j] * accelerations.back(j + 1)[i];
    v[i] = w[i] / h + h * sum;
  }
}

}  // namespace mbs::csc_klu
