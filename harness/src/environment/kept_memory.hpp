// Memory that is freed stays with the process, as every real-time program wants it.
#pragma once

#include <malloc.h>

#include <climits>

namespace mbs {

/// By default glibc gives the top of the heap back from 128 KiB on: a library that allocates its
/// workspace in each factorization then gets new pages each time, which can take longer than the
/// arithmetic. To be called first in main().
inline void keep_memory() {
#if defined(__GLIBC__)
  constexpr int kLargest = 32 << 20;  // B, that glibc takes for this limit
  ::mallopt(M_TRIM_THRESHOLD, INT_MAX);
  ::mallopt(M_MMAP_THRESHOLD, kLargest);
#endif
}

}  // namespace mbs
