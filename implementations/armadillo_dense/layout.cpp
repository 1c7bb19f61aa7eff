// Where each point's numbers are in extended vectors.
#include "layout.hpp"

namespace mbs::armadillo_dense {

Layout::Layout(const Model& model)
    : n(model.variables()), dimension(model.dimension()), size(model.variables()) {
  starts.reserve(model.points().size());
  for (const Point& point : model.points()) {
    starts.push_back(point.is_fixed() ? size : point.offset);
    if (point.is_fixed()) size += dimension;
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
