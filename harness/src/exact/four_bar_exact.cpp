// Jacobi elliptic functions from Boost.Math carry the closed form.
#include "exact/four_bar_exact.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>
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
}

FourBarExact::Angle FourBarExact::angle(double t) const {
  // Whole periods off first: the elliptic functions lose digits at large arguments.
  const long double u = std::fmod(quarter_ + w_ * t / 2, 4 * quarter_);
  long double cn = 0, unused = 0;
  const long double sn = boost::math::jacobi_elliptic(modulus_, u, &cn, &unused);
  // dn^2 = 1 - mu sn^2 without its cancellation (1 - mu = 1 / w^2); Boost's own dn is 0/0 at u = K.
  const long double mu = modulus_ * modulus_;
  const long double dn = std::sqrt(1 / (w_ * w_) + mu * cn * cn);
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
  long double worst = 0;  // squared, which long double has room for
  for (int i = 0; i <= loops_; ++i) {
    const auto j = static_cast<std::size_t>(2 * i);
    const long double dx = q[j] - (i + x.sine), dy = q[j + 1] - x.cosine;
    const long double square = dx * dx + dy * dy;
    if (!std::isfinite(square)) return std::numeric_limits<double>::quiet_NaN();
    worst = std::max(worst, square);
  }
  return static_cast<double>(std::sqrt(worst));
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
