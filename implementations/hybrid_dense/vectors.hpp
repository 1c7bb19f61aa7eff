// Aligned arrays of double, and vectors of as many as the processor's registers hold.
#pragma once

#include <span>
#include <vector>

namespace mbs::hybrid_dense {

#ifdef __AVX512F__
inline constexpr int kWidth = 8;
#else
inline constexpr int kWidth = 4;
#endif

typedef double Vec __attribute__((vector_size(kWidth * sizeof(double)), may_alias));

/// n, rounded up to whole vectors.
constexpr long padded(long n) { return (n + kWidth - 1) / kWidth * kWidth; }

/// A zeroed array that starts on a cache line and may be read up to the next one.
class Array {
 public:
  explicit Array(long size = 0) : lines_((size + 7) / 8) {}
  double* data() { return lines_.empty() ? nullptr : lines_[0].values; }
  const double* data() const { return lines_.empty() ? nullptr : lines_[0].values; }
  double& operator[](long i) { return data()[i]; }
  double operator[](long i) const { return data()[i]; }

 private:
  struct alignas(64) Line {
    double values[8] = {};
  };
  std::vector<Line> lines_;
};

[[gnu::always_inline]] inline Vec load(const double* p) { return *reinterpret_cast<const Vec*>(p); }
[[gnu::always_inline]] inline void store(double* p, const Vec& x) {
  *reinterpret_cast<Vec*>(p) = x;
}
[[gnu::always_inline]] inline Vec broadcast(double x) {
#ifdef __AVX512F__
  return Vec{x, x, x, x, x, x, x, x};
#else
  return Vec{x, x, x, x};
#endif
}

/// Entry t of the result is the sum of the entries of x[t].
[[gnu::always_inline]] inline Vec sums(const Vec (&x)[kWidth]) {
#ifdef __AVX512F__
  Vec pairs[4], fours[2];
  for (int t = 0; t < 4; ++t) {
    pairs[t] = __builtin_shufflevector(x[2 * t], x[2 * t + 1], 0, 8, 2, 10, 4, 12, 6, 14) +
               __builtin_shufflevector(x[2 * t], x[2 * t + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int t = 0; t < 2; ++t) {
    fours[t] = __builtin_shufflevector(pairs[2 * t], pairs[2 * t + 1], 0, 1, 8, 9, 4, 5, 12, 13) +
               __builtin_shufflevector(pairs[2 * t], pairs[2 * t + 1], 2, 3, 10, 11, 6, 7, 14, 15);
  }
  return __builtin_shufflevector(fours[0], fours[1], 0, 1, 2, 3, 8, 9, 10, 11) +
         __builtin_shufflevector(fours[0], fours[1], 4, 5, 6, 7, 12, 13, 14, 15);
#else
  Vec pairs[2];
  for (int t = 0; t < 2; ++t) {
    pairs[t] = __builtin_shufflevector(x[2 * t], x[2 * t + 1], 0, 4, 2, 6) +
               __builtin_shufflevector(x[2 * t], x[2 * t + 1], 1, 5, 3, 7);
  }
  return __builtin_shufflevector(pairs[0], pairs[1], 0, 1, 4, 5) +
         __builtin_shufflevector(pairs[0], pairs[1], 2, 3, 6, 7);
#endif
}

}  // namespace mbs::hybrid_dense
