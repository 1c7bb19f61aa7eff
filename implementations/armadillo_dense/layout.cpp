// Where each point's numbers are in extended vectors.
#include "layout.hpp"

namespace mbs::armadillo_dense {

Layout::Layout(const Model& model)
    : n(model.variables()), dimension(model.dimension()), moving(n), size(n) {
  for (const Point& point : model.points()) starts.push_back(point.is_fixed() ? -1 : point.offset);
  for (const DrivenPoint& driven : model.driven_points()) {
    starts[driven.point] = moving;
    moving += dimension;
  }
  size = moving;
  for (int& start : starts) {
    if (start >= 0) continue;
    start = size;
    size += dimension;
  }
}

arma::vec Layout::positions(const Model& model) const {
  arma::vec positions = zeros();
  for (std::size_t i = 0; i < starts.size(); ++i) {
    std::copy_n(model.points()[i].position.begin(), dimension, positions.begin() + starts[i]);
  }
  return positions;
}

}  // namespace mbs::armadillo_dense
