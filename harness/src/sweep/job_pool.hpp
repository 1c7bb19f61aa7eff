// Pieces of work side by side in processes, since not every library may be used by two threads.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace mbs {

inline constexpr int kMostJobs = 1024;

/// Calls `prepare`, if there is one, of each block; when all are prepared, `work` of each and
/// `keep` with its result; and `show` now and then with how many are prepared and kept. With
/// several jobs they all run in processes that are copies of this one as it is now; `keep` never in
/// two at once. Each process takes its next block by itself, in order, when its last is kept: what
/// is lost with all of them is a block a job. It begins with those that it has prepared, in whose
/// memory they may still be. After an exception no more are begun, those that were end, and what
/// the first of them threw is thrown here: a UsageError, a std::bad_alloc or a std::runtime_error.
/// Throws UsageError at once if a process is lost.
void for_blocks(int jobs, std::span<const long> blocks,
                const std::function<std::string(long)>& work,
                const std::function<void(long, const std::string&)>& keep,
                const std::function<void(std::size_t prepared, std::size_t kept)>& show,
                const std::function<void(long)>& prepare = {});

}  // namespace mbs
