// Where the points of a model are found: in extended vectors and among the coordinates.
#include "layout.hpp"

#include <algorithm>

namespace mbs::eigen_dense {

Layout::Layout(const Model& model)
    : variables_(model.variables()), dimension_(model.dimension()), extended_size_(variables_) {
  for (const Point& point : model.points()) {
    start_.push_back(point.is_fixed() ? extended_size_ : point.offset);
    if (point.is_fixed()) extended_size_ += dimension_;
  }
}

Shares Layout::shares(std::initializer_list<int> points) const {
  Shares shares;
  Share* const first = shares.items.data();
  int position = 0;
  for (const int point : points) {
    const double sign = position % 2 == 0 ? 1.0 : -1.0;
    const bool in_u = position < 2;
    ++position;
    const Index at = start(point);
    if (at >= variables_) continue;
    Share* const end = first + shares.count;
    Share* const share =
        std::find_if(first, end, [at](const Share& other) { return other.start >= at; });
    if (share == end || share->start != at) {
      std::move_backward(share, end, end + 1);
      *share = {at, 0.0, 0.0};
      ++shares.count;
    }
    (in_u ? share->in_u : share->in_w) += sign;
  }
  return shares;
}

Eigen::VectorXd Layout::initial_position(const Model& model) const {
  Eigen::VectorXd q(extended_size_);
  for (std::size_t k = 0; k < start_.size(); ++k) {
    std::copy_n(model.points()[k].position.begin(), dimension_, q.data() + start_[k]);
  }
  return q;
}

}  // namespace mbs::eigen_dense
