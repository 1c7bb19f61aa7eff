// The tangent, entry by entry: which products of Jacobian entries each one is the sum of.
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::hybrid_dense {

/// Writes M + s Phi_q^T Phi_q, but only those entries that change from pass to pass. All others
/// keep what write_mass() gave them.
class Schedule {
 public:
  /// Of an entry (row, column), row >= column.
  using Position = std::function<long(long row, long column)>;

  /// Row k of Phi_q has the entries first[k] ... first[k + 1] - 1, of the coordinates `slots`;
  /// slots from n on have no column. `others` are (row, column) of entries that others will add to.
  Schedule(const Model& model, std::span<const int> first, std::span<const int> slots,
           std::span<const std::pair<int, int>> others, const Position& position);

  static void write_mass(const Model& model, const Position& position, double* T);
  void assemble(double s, const double* Phi_q, double* T) const;

 private:
  struct Entry {
    long position;
    double mass;
  };
  struct Pair {
    int left, right;  // into Phi_q
  };
  struct Group {  // entries with equally many products
    int products, entries;
  };
  template <int Products>
  static void assemble_group(const Group& group, double s, const double* Phi_q, double* T,
                             const Entry*& entry, const Pair*& pair);

  std::vector<Group> groups_;
  std::vector<Entry> entries_;
  std::vector<Pair> pairs_;
};

}  // namespace mbs::hybrid_dense
