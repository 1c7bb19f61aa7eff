// The trapezoidal rule, Eq. (2), on whole vectors: prediction and correction.
#pragma once

#include <cmath>
#include <limits>

namespace mbs::csc_klu {

/// Turns q, v, a (each n) into the prediction for a time `h` (s) later.
inline void predict(int n, double h, double* __restrict q, double* __restrict v,
                    double* __restrict a) {
  for (int i = 0; i < n; ++i) {
    const double end = q[i] + h * v[i] + (h * h / 2.0) * a[i];
    const double moved = end - q[i];
    const double start_v = v[i];
    q[i] = end;
    v[i] = (2.0 / h) * moved - start_v;                           // Eq. (2)
    a[i] = (4.0 / (h * h)) * moved - (4.0 / h) * start_v - a[i];  // Eq. (2)
  }
}

/// Adds to v and a what belongs to an increment of q (n); true if that is within the tolerance,
/// which no NaN is.
inline bool correct(int n, double h, double tolerance, const double* __restrict increment,
                    double* __restrict v, double* __restrict a) {
  long long beyond = 0;
  for (int i = 0; i < n; ++i) {
    beyond |= !(std::abs(increment[i]) <= tolerance);
    v[i] += (2.0 / h) * increment[i];        // Eq. (2)
    a[i] += (4.0 / (h * h)) * increment[i];  // Eq. (2)
  }
  return beyond == 0;
}

/// The largest absolute value of x (n); NaN if x has one.
inline double largest(int n, const double* x) {
  double found = 0.0;
  long long unordered = 0;
  for (int i = 0; i < n; ++i) {
    const double size = std::abs(x[i]);
    unordered |= size != size;
    found = size > found ? size : found;
  }
  return unordered == 0 ? found : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace mbs::csc_klu
