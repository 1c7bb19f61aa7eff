// Compares with what was.
#include "sweep/output_extremes.hpp"

#include <algorithm>

namespace mbs {

void OutputExtremes::follow(double t, const State& state) {
  outputs_.follow(t, state);
  const std::vector<double> values = outputs_.values();
  if (columns_.empty()) {
    for (const double value : values) columns_.push_back({value, value, value});
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    columns_[i] = {values[i], std::min(columns_[i].least, values[i]),
                   std::max(columns_[i].most, values[i])};
  }
}

}  // namespace mbs
