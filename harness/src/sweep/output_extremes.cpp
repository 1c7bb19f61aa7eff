// Compares with what was.
#include "sweep/output_extremes.hpp"

#include <algorithm>

namespace mbs {

void OutputExtremes::follow(double t, const State& state) {
  outputs_.follow(t, state);
  values_.resize(outputs_.columns().size());
  outputs_.values(values_);
  if (columns_.empty()) {
    for (const double value : values_) columns_.push_back({value, value, value});
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    columns_[i] = {values_[i], std::min(columns_[i].least, values_[i]),
                   std::max(columns_[i].most, values_[i])};
  }
}

}  // namespace mbs
