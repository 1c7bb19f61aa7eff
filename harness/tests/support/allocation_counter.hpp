// Counts heap allocations of the whole process, those of its shared libraries included.
#pragma once

namespace mbs::test {

/// Whether this build counts. Sanitizers bring a malloc of their own, which cannot be replaced.
bool counts_allocations();

/// Calls of malloc, calloc, realloc, aligned_alloc, posix_memalign, memalign, valloc and pvalloc
/// since the process started; operator new is among them, because libstdc++ gets its memory there.
long allocations();

}  // namespace mbs::test
