// A pair of numbers that counts what is done to it and knows when it is ready.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "limit/pair.hpp"

namespace mbs::limit {

/// Operations on single numbers (a pair counts as two), and bytes of loads and stores.
struct Operations {
  long add = 0;  ///< additions and subtractions
  long multiply = 0;
  long fused = 0;  ///< multiply-adds, two flops each
  long divide = 0;
  long compare = 0;
  long loaded = 0, stored = 0;  ///< bytes

  [[nodiscard]] long flops() const { return add + multiply + 2 * fused + divide; }
};

/// Time from operands to result, ns.
struct Latencies {
  double add = 0.0, multiply = 0.0, fused = 0.0, divide = 0.0;
};

/// Takes the place of Pair in Chain. Not for several threads: all count in one place.
struct Counted {
  double value[2] = {0.0, 0.0};
  double ready = 0.0;  ///< ns; as soon as its operands allow it, whatever else is to be done

  inline static Operations operations;
  inline static Latencies latencies;
};

/// Applies `function` to each lane, ready `latency` after the last operand; counts it in `count`.
template <class Function, class... Operands>
Counted counted(long& count, double latency, Function&& function, const Operands&... operands) {
  count += 2;
  Counted result;
  for (int i = 0; i < 2; ++i) result.value[i] = function(operands.value[i]...);
  result.ready = std::max({operands.ready...}) + latency;
  return result;
}

inline Counted operator+(const Counted& a, const Counted& b) {
  return counted(
      Counted::operations.add, Counted::latencies.add, [](double x, double y) { return x + y; }, a,
      b);
}
inline Counted operator-(const Counted& a, const Counted& b) {
  return counted(
      Counted::operations.add, Counted::latencies.add, [](double x, double y) { return x - y; }, a,
      b);
}
inline Counted operator*(const Counted& a, const Counted& b) {
  return counted(
      Counted::operations.multiply, Counted::latencies.multiply,
      [](double x, double y) { return x * y; }, a, b);
}
inline Counted fma(const Counted& a, const Counted& b, const Counted& c) {
  return counted(
      Counted::operations.fused, Counted::latencies.fused,
      [](double x, double y, double z) { return std::fma(x, y, z); }, a, b, c);
}
/// A sign costs nothing: instructions with either sign exist.
inline Counted operator-(const Counted& a) { return {{-a.value[0], -a.value[1]}, a.ready}; }
inline Counted fms(const Counted& a, const Counted& b, const Counted& c) { return fma(a, b, -c); }
inline Counted fnma(const Counted& a, const Counted& b, const Counted& c) { return fma(-a, b, c); }
inline Counted reciprocal(const Counted& a) {
  return counted(
      Counted::operations.divide, Counted::latencies.divide, [](double x) { return 1.0 / x; }, a);
}
inline Counted swapped(const Counted& a) { return {{a.value[1], a.value[0]}, a.ready}; }
inline Counted larger_magnitude(const Counted& most, const Counted& x) {
  return counted(
      Counted::operations.compare, 0.0,
      [](double m, double v) { return m > std::abs(v) ? m : std::abs(v); }, most, x);
}

template <>
inline Counted make<Counted>(double left, double right) {
  return {{left, right}, 0.0};
}
inline double lane(const Counted& a, int which) { return a.value[which]; }
inline void set_lane(Counted& a, int which, double value) { a.value[which] = value; }

inline Counted load(const Counted& place) {
  Counted::operations.loaded += static_cast<long>(sizeof(Pair));
  return place;
}
inline void store(Counted& place, const Counted& value) {
  Counted::operations.stored += static_cast<long>(sizeof(Pair));
  place = value;
}

}  // namespace mbs::limit
