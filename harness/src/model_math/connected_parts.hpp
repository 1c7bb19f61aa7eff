// Which points act on each other.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// Points are of one part if a row, mass, spring, law or couple has both. What drivers move is of
/// one part; what other points are fixed to joins nothing.
class ConnectedParts {
 public:
  /// `model` must outlive this. Without `by_forces` only rows and masses join.
  explicit ConnectedParts(const Model& model, bool by_forces = true);

  /// Free points of each part that no driver touches.
  [[nodiscard]] std::vector<std::vector<int>> undriven();
  /// A number that coordinates (indices into q) of one part have in common, below points + 1.
  [[nodiscard]] int part_of(int coordinate) { return find(owner(coordinate)); }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }
  [[nodiscard]] std::size_t dimension() const { return at(model_.dimension()); }
  [[nodiscard]] int driver() const { return static_cast<int>(leader_.size()) - 1; }
  [[nodiscard]] int owner(int coordinate) const { return point_at_[at(coordinate) / dimension()]; }
  int find(int point);
  void drive(std::initializer_list<int> points);
  void join(std::initializer_list<int> points);

  const Model& model_;
  std::vector<int> leader_;  // of points; last: what drivers move
  std::vector<bool> is_driven_;
  std::vector<int> point_at_;  // of each free point, in the order of q
};

}  // namespace mbs
