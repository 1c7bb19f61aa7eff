// F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304: slopes that keep what F.
// N. Fritsch and R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238-246, ask of a monotone cubic.
#include "model_math/monotone_curve.hpp"

#include <cmath>

namespace mbs {
namespace {

/// Weighted harmonic mean of the slopes `before` and `after` a row, zero at a peak.
double slope_between(double before, double after, double h_before, double h_after) {
  if ((before > 0.0) != (after > 0.0) || before == 0.0 || after == 0.0) return 0.0;
  const double first = h_before + 2 * h_after, second = 2 * h_before + h_after;
  return (first + second) / (first / before + second / after);
}

/// Of one piece, from its origin.
double integral(const Curve::Piece& piece, double from, double to) {
  const auto at = [&piece](double x) {
    const auto& [c0, c1, c2, c3] = piece.coefficients;
    const double z = x - piece.origin;
    return z * (c0 + z * (c1 / 2 + z * (c2 / 3 + z * c3 / 4)));
  };
  return at(to) - at(from);
}

}  // namespace

Curve monotone_curve(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t last = x.size() - 1;
  std::vector<double> h, secant;
  for (std::size_t i = 0; i < last; ++i) {
    h.push_back(x[i + 1] - x[i]);
    secant.push_back((y[i + 1] - y[i]) / h[i]);
  }
  std::vector<double> slope{secant.front()};
  for (std::size_t i = 1; i < last; ++i) {
    slope.push_back(slope_between(secant[i - 1], secant[i], h[i - 1], h[i]));
  }
  slope.push_back(secant.back());
  Curve curve{x, {{x.front(), {y.front(), slope.front(), 0.0, 0.0}}}};
  for (std::size_t i = 0; i < last; ++i) {  // differences first: a straight line stays one exactly
    const double at_start = slope[i] - secant[i], at_end = slope[i + 1] - secant[i];
    curve.pieces.push_back(
        {x[i],
         {y[i], slope[i], -(2 * at_start + at_end) / h[i], (at_start + at_end) / (h[i] * h[i])}});
  }
  curve.pieces.push_back({x.back(), {y.back(), slope.back(), 0.0, 0.0}});
  return curve;
}

double integral(const Curve& curve, double x) {
  if (curve.breaks.empty()) return 0.0;
  std::size_t zero = 0;
  for (std::size_t i = 1; i < curve.breaks.size(); ++i) {
    if (std::abs(curve.at(curve.breaks[i]).value) < std::abs(curve.at(curve.breaks[zero]).value)) {
      zero = i;
    }
  }
  double from = curve.breaks[zero], sum = 0.0;
  std::size_t piece = curve.piece_at(from);
  for (; piece < curve.piece_at(x); ++piece) {
    sum += integral(curve.pieces[piece], from, curve.breaks[piece]);
    from = curve.breaks[piece];
  }
  for (; piece > curve.piece_at(x); --piece) {
    sum += integral(curve.pieces[piece], from, curve.breaks[piece - 1]);
    from = curve.breaks[piece - 1];
  }
  return sum + integral(curve.pieces[piece], from, x);
}

}  // namespace mbs
