// Set-up of an Assembly.
#pragma once

#include <array>
#include <vector>

#include "assembly.hpp"
#include "points.hpp"

namespace mbs::csc_mumps {

/// Fills the lists of an Assembly from a model; used once, at construction.
class Assembly::Builder {
 public:
  Builder(Assembly& assembly, const Model& model)
      : self_(assembly), model_(model), points_(model) {}

  /// `step` = Delta t (s).
  void build(double step);

 private:
  void collect_rows();
  void compress_jacobian();
  [[nodiscard]] int place(int row, int column) const;
  [[nodiscard]] std::array<int, kPointsOfDot> offsets(int a, int b, int c, int d) const;
  void lower_products();
  void lower_distance(const Distance& distance);
  void lower_gradients(const Dot& dot);
  void lower_linear();
  void attach_drivers();
  void build_mass();

  Assembly& self_;
  const Model& model_;
  ExtendedPoints points_;
  std::vector<std::vector<int>> columns_of_;  // structural non-zeros of a row of Phi_q, ascending
};

}  // namespace mbs::csc_mumps
