// Exact motion of the N-loop four-bar mechanism: the oracle that no implementation provides.
#pragma once

#include <span>

namespace mbs {

/// Closed-form solution of Eqs. (9) and (10) in Jacobi elliptic functions, evaluated in long
/// double. Valid on the parallelogram branch, on which all rods share one angle phi from the upward
/// vertical.
class FourBarExact {
 public:
  /// N = loops >= 1.
  explicit FourBarExact(int loops);

  struct Angle {
    long double sine, cosine;  ///< sin phi, cos phi
    long double rate;          ///< phi', rad/s
    long double acceleration;  ///< phi'', rad/s^2
  };
  /// The common angle at time t >= 0 (s).
  [[nodiscard]] Angle angle(double t) const;

  /// Writes q (m), v (m/s) and a (m/s^2) of B_0 ... B_N at time t, each of size 2 N + 2.
  void state(double t, std::span<double> q, std::span<double> v, std::span<double> a) const;

  /// Largest distance of a point B_i in `q` from its exact place at time t, m; NaN if q holds one.
  [[nodiscard]] double position_error(double t, std::span<const double> q) const;

  /// Largest difference of B_i - A_i from B_0 - A_0, m: 0 on the parallelogram branch, up to 2 m
  /// off it. Moderate on it too where constraints are violated. NaN if `q` holds one.
  [[nodiscard]] double distance_from_branch(std::span<const double> q) const;

  /// First time at which all rods lie on one line, cos phi = 0 (s).
  [[nodiscard]] double first_singular_time() const;

 private:
  struct Theta {
    long double first = 0, second = 0, third = 1, fourth = 1;
  };
  [[nodiscard]] Theta theta(long double z) const;

  int loops_;
  long double k_;        // Eq. (9), 1/s^2
  long double w_;        // Eq. (10), 1/s
  long double modulus_;  // sqrt(mu)
  long double quarter_;  // K(mu)
  long double nome_;     // exp(-pi K(1 - mu) / K(mu))
  Theta at_zero_;
};

}  // namespace mbs
