// The lanes of a sweep in blocks, each of what goes side by side: rows do not depend on who runs it.
#pragma once

#include <string>
#include <vector>

#include "mbs/sweep_options.hpp"
#include "mbs/sweep_rows.hpp"
#include "run/run.hpp"
#include "sweep/sweep_grid.hpp"

namespace mbs {

/// Throws UsageError if they do not go with `scene`.
RunSettings resolve(const SweepOptions& options, const Scene& scene);

/// Options, grid and variant must outlive it.
class SweepBlocks {
 public:
  SweepBlocks(const SweepOptions& options, const SweepGrid& grid, const Variant& variant);

  [[nodiscard]] const SweepRows& rows() const { return rows_; }
  [[nodiscard]] long count() const { return (grid_.lanes() + size_ - 1) / size_; }
  /// Of all these blocks.
  [[nodiscard]] long lanes(const std::vector<long>& blocks) const;
  /// Throws UsageError of the first lane that makes no scene.
  void check(long block) const;
  /// A line of outcomes, then the rows.
  [[nodiscard]] std::string run(long block) const;

 private:
  [[nodiscard]] long end_of(long block) const;
  [[nodiscard]] Lane prepare(long index) const;

  const SweepOptions& options_;
  const SweepGrid& grid_;
  const Variant& variant_;
  SweepRows rows_;
  long size_;
};

}  // namespace mbs
