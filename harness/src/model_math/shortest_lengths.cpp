// The lengths that quadratic constraints measure.
#include "model_math/shortest_lengths.hpp"

#include <algorithm>
#include <cmath>

#include "model_math/vector3.hpp"

namespace mbs {

std::vector<double> shortest_lengths(const Model& model) {
  const auto points = model.points();
  std::vector<double> result(points.size(), 0.0);
  const auto see = [&](int a, int b) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const Vector3 d = points[i].position - points[j].position;
    const double length = std::hypot(d[0], d[1], d[2]);
    if (length == 0.0) return;
    for (const std::size_t k : {i, j}) {
      result[k] = result[k] > 0.0 ? std::min(result[k], length) : length;
    }
  };
  const auto see_both = [&](const auto& c) {
    see(c.a, c.b);
    see(c.c, c.d);
  };
  for (const DotConstraint& c : model.dot_constraints()) see_both(c);
  for (const BilinearConstraint& c : model.bilinear_constraints()) see_both(c);
  return result;
}

}  // namespace mbs
