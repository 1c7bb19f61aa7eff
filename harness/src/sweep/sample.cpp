// Uniform 64-bit numbers, then the inverse of the distribution function.
#include "sweep/sample.hpp"

#include <fmt/format.h>

#include <boost/math/distributions/normal.hpp>
#include <boost/random/sobol.hpp>
#include <random>

#include "printable.hpp"
#include "sweep/value_range.hpp"

namespace mbs {

double random_share(std::uint64_t bits) {  // the half must not be rounded: 52 bits
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

std::optional<Distribution> parse_distribution(const std::string& text, const std::string& path) {
  const bool uniform = text.starts_with("uniform:");
  if (!uniform && !text.starts_with("normal:")) return std::nullopt;
  const std::string numbers = text.substr(text.find(':') + 1);
  const auto colon = numbers.find(':');
  const char* allowed = uniform ? "uniform:a:b, a below b" : "normal:mean:deviation, above 0";
  if (colon == std::string::npos) refuse_vary(path, in_quotes(text), allowed);
  const double first = parse_number(numbers.substr(0, colon), path);
  const double second = parse_number(numbers.substr(colon + 1), path);
  if (!(second > (uniform ? first : 0.0))) refuse_vary(path, in_quotes(text), allowed);
  return Distribution{uniform ? Distribution::Kind::uniform : Distribution::Kind::normal, first,
                      second};
}

double value_at(const Distribution& distribution, double share) {
  if (distribution.kind == Distribution::Kind::uniform) {
    return distribution.first + (distribution.second - distribution.first) * share;
  }
  return boost::math::quantile(boost::math::normal(distribution.first, distribution.second), share);
}

std::vector<std::vector<double>> draw_shares(std::size_t numbers, const Sampling& sampling) {
  const auto count = static_cast<std::size_t>(sampling.count);
  std::vector<std::vector<double>> shares(numbers, std::vector<double>(count));
  std::mt19937_64 random(sampling.seed);
  boost::random::sobol sobol(std::max<std::size_t>(numbers, 1));
  std::vector<std::uint64_t> shifts(numbers);
  for (auto& shift : shifts) shift = sampling.sobol ? random() : 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < numbers; ++k) {
      // Boost's sequence leaves its first point, 0, out, without which 2^k points are not even.
      const std::uint64_t bits = !sampling.sobol ? random() : (i == 0 ? 0 : sobol()) ^ shifts[k];
      shares[k][i] = random_share(bits);
    }
  }
  return shares;
}

}  // namespace mbs
