// From journals of a sweep to its table.
#pragma once

#include <string>
#include <vector>

#include "sweep/journal.hpp"

namespace mbs {

/// Throws UsageError that says what differs.
void require_same_sweep(const Journal& journal, const nlohmann::json& head);

/// Writes the rows of all blocks, which the parts must have, says how it went; the exit status. Removes what was
/// left beside `output` by a process that was killed while it did this.
int write_table(const std::vector<const Journal*>& parts, const std::string& output);

/// Whether all blocks of a part are there, not damaged.
bool has_all_blocks(const Journal& part);

/// Says how a part went; the exit status.
int finish_part(const Journal& part);

/// `mbs merge-sweep`.
int merge_sweep(const std::vector<std::string>& paths, const std::string& output);

}  // namespace mbs
