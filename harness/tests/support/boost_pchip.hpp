// Boost's monotone interpolation, for what must not be evaluated by what it is held against.
#pragma once

// clang-format off: pchip.hpp uses fpclassify.hpp and does not say so.
#include <boost/math/special_functions/fpclassify.hpp>
#include <boost/math/interpolators/pchip.hpp>
// clang-format on
#include <utility>
#include <vector>

namespace mbs::test {

inline boost::math::interpolators::pchip<std::vector<double>> boost_pchip(std::vector<double> x,
                                                                          std::vector<double> y) {
  return {std::move(x), std::move(y)};
}

}  // namespace mbs::test
