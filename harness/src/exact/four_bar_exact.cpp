// Jacobi elliptic functions, by their theta series, carry the closed form.
#include "exact/four_bar_exact.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace mbs {

FourBarExact::FourBarExact(int loops) : loops_(loops) {
  if (loops < 1) throw std::invalid_argument("the N-four-bar needs N >= 1");
  constexpr long double gravity = 9.81L;
  const long double n = loops;
  k_ = 3 * gravity * (3 * n + 1) / (2 * (4 * n + 1));
  w_ = std::sqrt(1 + 4 * k_);
  modulus_ = std::sqrt(4 * k_) / w_;
  quarter_ = boost::math::ellint_1(modulus_);
  nome_ = std::exp(-boost::math::constants::pi<long double>() * boost::math::ellint_1(1 / w_) /
                   quarter_);
  at_zero_ = theta(0);
}

/// The theta functions of argument z, without the factor 2 q^(1/4) of the first two. As the nome q
/// is below 0.23 for every N, six terms leave less than long double resolves. Boost's
/// jacobi_elliptic takes much longer, most of what it costs to judge a state.
FourBarExact::Theta FourBarExact::theta(long double z) const {
  constexpr int kTerms = 6;
  long double cosine = std::cos(z), sine = std::sin(z);  // of (2 j + 1) z
  const long double turn_cosine = (cosine - sine) * (cosine + sine), turn_sine = 2 * sine * cosine;
  long double even = turn_cosine, even_sine = turn_sine;  // of 2 (j + 1) z
  long double odd_power = 1, even_power = nome_;          // q^(j (j + 1)), q^((j + 1)^2)
  long double power = nome_ * nome_, sign = 1;            // q^(2 (j + 1)), (-1)^j
  Theta sum{0, 0, 1, 1};
  const auto turn = [&](long double& c, long double& s) {
    const long double before = c;
    c = c * turn_cosine - s * turn_sine;
    s = s * turn_cosine + before * turn_sine;
  };
  for (int j = 0; j < kTerms; ++j) {
    sum.first += sign * odd_power * sine;
    sum.second += odd_power * cosine;
    sum.third += 2 * even_power * even;
    sum.fourth -= 2 * sign * even_power * even;
    turn(cosine, sine);
    turn(even, even_sine);
    odd_power *= power;
    even_power *= power * nome_;
    power *= nome_ * nome_;
    sign = -sign;
  }
  return sum;
}

FourBarExact::Angle FourBarExact::angle(double t) const {
  // Whole periods off first: a large argument has lost digits.
  const long double u = std::fmod(quarter_ + w_ * t / 2, 4 * quarter_);
  const Theta at = theta(boost::math::constants::half_pi<long double>() * u / quarter_);
  const long double sn = at_zero_.third / at_zero_.second * at.first / at.fourth;
  const long double cn = at_zero_.fourth / at_zero_.second * at.second / at.fourth;
  const long double dn = at_zero_.fourth / at_zero_.third * at.third / at.fourth;
  const long double sine = -2 * sn * cn;
  return {sine, 2 * sn * sn - 1, w_ * dn, k_ * sine};  // Eqs. (10), (9)
}

void FourBarExact::state(double t, std::span<double> q, std::span<double> v,
                         std::span<double> a) const {
  const Angle x = angle(t);
  const long double square = x.rate * x.rate;
  for (int i = 0; i <= loops_; ++i) {
    const auto j = static_cast<std::size_t>(2 * i);
    q[j] = static_cast<double>(i + x.sine);
    q[j + 1] = static_cast<double>(x.cosine);
    v[j] = static_cast<double>(x.cosine * x.rate);
    v[j + 1] = static_cast<double>(-x.sine * x.rate);
    a[j] = static_cast<double>(x.cosine * x.acceleration - x.sine * square);
    a[j + 1] = static_cast<double>(-x.sine * x.acceleration - x.cosine * square);
  }
}

double FourBarExact::position_error(double t, std::span<const double> q) const {
  const Angle x = angle(t);
  const auto sine = static_cast<double>(x.sine), cosine = static_cast<double>(x.cosine);
  double worst = 0.0, sum = 0.0;  // squared
  for (int i = 0; i <= loops_; ++i) {
    const auto j = static_cast<std::size_t>(2 * i);
    const double dx = q[j] - i - sine, dy = q[j + 1] - cosine;
    const double square = dx * dx + dy * dy;
    worst = std::max(worst, square);
    sum += square;  // a NaN stays
  }
  return std::isfinite(sum) ? std::sqrt(worst) : std::numeric_limits<double>::quiet_NaN();
}

double FourBarExact::distance_from_branch(std::span<const double> q) const {
  double worst = 0.0;
  for (int i = 1; i <= loops_; ++i) {
    const auto j = static_cast<std::size_t>(2 * i);
    const double distance = std::hypot(q[j] - i - q[0], q[j + 1] - q[1]);
    if (!std::isfinite(distance)) return std::numeric_limits<double>::quiet_NaN();
    worst = std::max(worst, distance);
  }
  return worst;
}

double FourBarExact::first_singular_time() const {
  const long double eighth = boost::math::constants::pi<long double>() / 4;
  return static_cast<double>(2 * (quarter_ - boost::math::ellint_1(modulus_, eighth)) / w_);
}

}  // namespace mbs
