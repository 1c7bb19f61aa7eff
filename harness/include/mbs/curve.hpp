// Piecewise cubic functions of one number: what laws of forces are tabulated as.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace mbs {

/// A function c(x) made of cubic pieces, value and slope continuous: Eq. (19). The first piece and
/// the last have no end of their own, so that nobody has to ask whether x is outside of the table.
///
/// Example: zero to x = 0, then 2 x^2, straight on from x = 1, has breaks = {0, 1} and
/// pieces = {{0, {}}, {0, {0, 0, 2, 0}}, {1, {2, 4, 0, 0}}}.
struct Curve {
  /// c0 + c1 z + c2 z^2 + c3 z^3 with z = x - origin.
  struct Piece {
    double origin = 0.0;
    std::array<double, 4> coefficients{};
  };
  struct Sample {
    double value = 0.0, slope = 0.0;  ///< c(x), c'(x)
  };

  std::vector<double> breaks = {};   ///< increasing
  std::vector<Piece> pieces = {{}};  ///< one more: piece k holds from breaks[k - 1] to breaks[k]

  /// The piece that x is in: as many breaks as are at most x.
  [[nodiscard]] std::size_t piece_at(double x) const {
    return static_cast<std::size_t>(std::upper_bound(breaks.begin(), breaks.end(), x) -
                                    breaks.begin());
  }
  [[nodiscard]] Sample at(double x) const {
    const Piece& piece = pieces[piece_at(x)];
    const auto& [c0, c1, c2, c3] = piece.coefficients;
    const double z = x - piece.origin;
    return {c0 + z * (c1 + z * (c2 + z * c3)), c1 + z * (2 * c2 + z * 3 * c3)};
  }
  /// Whether it is zero everywhere, as by default.
  [[nodiscard]] bool is_zero() const {
    return std::ranges::all_of(
        pieces, [](const Piece& one) { return one.coefficients == std::array<double, 4>{}; });
  }
};

}  // namespace mbs
