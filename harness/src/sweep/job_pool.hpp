// Pieces of work side by side in processes, since not every library may be used by two threads.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace mbs {

/// Calls `work` of each block and `take` with its result, which comes when it is there, in any order;
/// no more are begun once `take` returns false. With several jobs `work` runs in processes that are
/// copies of this one as it is now. A process has one block at a time, so that what is lost with all
/// of them is a block a job. Rethrows a UsageError of `work`; throws std::runtime_error if a process
/// is lost.
void for_blocks(int jobs, std::span<const long> blocks,
                const std::function<std::string(long)>& work,
                const std::function<bool(long, std::string)>& take);

}  // namespace mbs
