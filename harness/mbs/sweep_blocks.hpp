// The lanes of a sweep in blocks, each of what goes side by side: rows do not depend on who runs it.
#pragma once

#include <map>
#include <optional>
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
  void check(long block);
  /// A line of outcomes, then the rows. Takes less time where the block was checked before.
  [[nodiscard]] std::string run(long block);

 private:
  /// To run, or why its start cannot be assembled.
  struct Prepared {
    std::optional<Lane> lane;
    std::string not_assembled = {};
  };

  [[nodiscard]] long end_of(long block) const;
  [[nodiscard]] Prepared prepare(long index) const;
  [[nodiscard]] std::vector<Prepared> prepare_all(long block) const;

  const SweepOptions& options_;
  const SweepGrid& grid_;
  const Variant& variant_;
  SweepRows rows_;
  long size_;
  std::map<long, std::vector<Prepared>> held_;  // blocks that were checked
  std::size_t most_held_;
};

}  // namespace mbs
