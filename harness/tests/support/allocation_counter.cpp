// Puts counting functions in front of glibc's allocator: the executable's symbols come first.
#include "support/allocation_counter.hpp"

#include <atomic>
#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)

namespace mbs::test {
bool counts_allocations() { return false; }
long allocations() { return 0; }
}  // namespace mbs::test

#else

namespace {

std::atomic<long> calls{0};

void count() { calls.fetch_add(1, std::memory_order_relaxed); }

}  // namespace

// glibc's allocator under its other names. What they return may be given to the usual free().
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* __libc_valloc(std::size_t);
void* __libc_pvalloc(std::size_t);

void* malloc(std::size_t bytes) {
  count();
  return __libc_malloc(bytes);
}
void* calloc(std::size_t items, std::size_t bytes) {
  count();
  return __libc_calloc(items, bytes);
}
void* realloc(void* old, std::size_t bytes) {
  count();
  return __libc_realloc(old, bytes);
}
void* memalign(std::size_t alignment, std::size_t bytes) {
  count();
  return __libc_memalign(alignment, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  count();
  return __libc_memalign(alignment, bytes);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t bytes) {
  count();
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) {
    return EINVAL;
  }
  void* memory = __libc_memalign(alignment, bytes);
  if (memory == nullptr) return ENOMEM;
  *result = memory;
  return 0;
}
void* valloc(std::size_t bytes) {
  count();
  return __libc_valloc(bytes);
}
void* pvalloc(std::size_t bytes) {
  count();
  return __libc_pvalloc(bytes);
}
}

namespace mbs::test {
bool counts_allocations() { return true; }
long allocations() { return calls.load(std::memory_order_relaxed); }
}  // namespace mbs::test

#endif
