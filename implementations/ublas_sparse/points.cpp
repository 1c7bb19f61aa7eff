// Lays the points of a Model out behind each other.
#include "points.hpp"

namespace mbs::ublas_sparse {

Points::Points(const Model& model)
    : variables_(model.variables()), dimension_(model.dimension()), position_(model.variables()) {
  for (const Point& point : model.points()) {
    first_.push_back(point.is_fixed() ? size() : point.offset);
    if (!point.is_fixed()) continue;
    position_.insert(position_.end(), point.position.begin(), point.position.begin() + dimension_);
  }
  velocity_.assign(position_.size(), 0.0);
}

}  // namespace mbs::ublas_sparse
