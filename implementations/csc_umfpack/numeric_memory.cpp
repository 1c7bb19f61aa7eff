// The allocation functions that UMFPACK sees during a factorization.
#include "numeric_memory.hpp"

#include <SuiteSparse_config.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <new>

namespace mbs::csc_umfpack {
namespace {

/// Every allocation is preceded by its size.
constexpr std::size_t kHeader = 16;
static_assert(kHeader >= sizeof(std::size_t) && kHeader >= alignof(std::max_align_t));

std::size_t rounded(std::size_t size) { return (size + kHeader - 1) / kHeader * kHeader; }

/// What was there before.
struct Functions {
  decltype(SuiteSparse_config.malloc_func) malloc = SuiteSparse_config.malloc_func;
  decltype(SuiteSparse_config.realloc_func) realloc = SuiteSparse_config.realloc_func;
  decltype(SuiteSparse_config.free_func) free = SuiteSparse_config.free_func;
};
const Functions& before() {
  static const Functions functions;
  return functions;
}

void write_size(void* data, std::size_t size) {
  std::memcpy(static_cast<std::byte*>(data) - kHeader, &size, sizeof size);
}

std::size_t read_size(const void* data) {
  std::size_t size;
  std::memcpy(&size, static_cast<const std::byte*>(data) - kHeader, sizeof size);
  return size;
}

}  // namespace

thread_local NumericMemory* NumericMemory::active_ = nullptr;

void NumericMemory::reset() {
  used_ = 0;
  if (required_ > capacity_) {
    block_.reset();
    block_.reset(new (std::nothrow) std::byte[required_]);
    capacity_ = block_ != nullptr ? required_ : 0;
  }
  required_ = 0;
}

bool NumericMemory::owns(const void* data) const {
  const auto address = static_cast<const std::byte*>(data);
  return std::greater_equal<>()(address, block_.get()) &&
         std::less<>()(address, block_.get() + capacity_);
}

void* NumericMemory::allocate(std::size_t size) {
  if (active_ == nullptr) return before().malloc(size);
  NumericMemory& memory = *active_;
  const std::size_t needed = kHeader + rounded(size);
  memory.required_ += needed;
  std::byte* start = nullptr;
  if (needed <= memory.capacity_ - memory.used_) {
    start = memory.block_.get() + memory.used_;
    memory.used_ += needed;
  } else {
    start = static_cast<std::byte*>(std::malloc(needed));
  }
  if (start == nullptr) return nullptr;
  write_size(start + kHeader, rounded(size));
  return start + kHeader;
}

void* NumericMemory::reallocate(void* data, std::size_t size) {
  if (active_ == nullptr) return before().realloc(data, size);
  if (data == nullptr) return allocate(size);
  if (size <= read_size(data)) return data;
  void* moved = allocate(size);
  if (moved == nullptr) return nullptr;
  std::memcpy(moved, data, read_size(data));
  release(data);
  return moved;
}

void NumericMemory::release(void* data) {
  if (active_ == nullptr) return before().free(data);
  if (data == nullptr || active_->owns(data)) return;  // the block is released as a whole
  std::free(static_cast<std::byte*>(data) - kHeader);
}

NumericMemory::Use::Use(NumericMemory& memory) {
  static const bool is_installed = [] {
    static_cast<void>(before());
    SuiteSparse_config.malloc_func = allocate;
    SuiteSparse_config.realloc_func = reallocate;
    SuiteSparse_config.free_func = release;
    return true;
  }();
  static_cast<void>(is_installed);
  active_ = &memory;
}

NumericMemory::Use::~Use() { active_ = nullptr; }

}  // namespace mbs::csc_umfpack
