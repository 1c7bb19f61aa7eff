// Random values for the numbers of a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mbs {

struct Sampling {
  long count = 0;  ///< 0: none
  std::uint64_t seed = 1;
  bool sobol = false;  ///< a Sobol sequence with a digital shift by the seed, else Mersenne Twister
};

struct Distribution {
  enum class Kind { uniform, normal } kind = Kind::uniform;
  double first = 0.0, second = 0.0;  ///< ends; mean and standard deviation
};

/// A number strictly between 0 and 1 of random bits.
double random_share(std::uint64_t bits);

/// "uniform:a:b" or "normal:mean:deviation"; nothing if it does not begin so. `path` is for errors.
/// Throws UsageError.
std::optional<Distribution> parse_distribution(const std::string& text, const std::string& path);

/// The value below which so large a share of a distribution lies.
double value_at(const Distribution& distribution, double share);

/// `count` shares for each of so many numbers; those of one index belong together. 2^k of a Sobol
/// sequence are a net: of 2^k even intervals of a number, each has one [Owen, 2020].
///
/// [Owen, 2020] A. B. Owen, On dropping the first Sobol' point, arXiv:2008.08051.
std::vector<std::vector<double>> draw_shares(std::size_t numbers, const Sampling& sampling);

}  // namespace mbs
