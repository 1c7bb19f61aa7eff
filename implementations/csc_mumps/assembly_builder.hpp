// Set-up of an Assembly: constraints in assembly_symbolic.cpp, M and T in tangent_symbolic.cpp.
#pragma once

#include <array>
#include <cstdint>
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
  /// One of the products that sum up to an entry of T, or just an entry (left = -1).
  struct Product {
    std::int64_t entry;  // column * n + row
    int left, right;
    bool operator<(const Product& other) const {
      return entry != other.entry ? entry < other.entry : left < other.left;
    }
  };

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
  void build_tangent();
  void schedule(const std::vector<Product>& products);
  void fill_constant();
  void locate_forces();
  [[nodiscard]] int entry(int row, int column) const;

  Assembly& self_;
  const Model& model_;
  ExtendedPoints points_;
  std::vector<std::vector<int>> columns_of_;  // structural non-zeros of a row of Phi_q, ascending
};

}  // namespace mbs::csc_mumps
