// Memory that UMFPACK's numeric objects live in, kept from one factorization to the next.
#pragma once

#include <cstddef>
#include <memory>

namespace mbs::csc_umfpack {

/// One block that serves all allocations of a factorization, the same sequence every pass, by
/// advancing through it. What does not fit comes from the heap, and the block is larger next time.
///
/// UMFPACK asks SuiteSparse_config, which is global, for its functions: the first Use puts some there
/// that serve a thread from this memory while it has a Use, and others as before.
class NumericMemory {
 public:
  NumericMemory() = default;
  NumericMemory(const NumericMemory&) = delete;
  NumericMemory& operator=(const NumericMemory&) = delete;

  /// Forgets everything that was allocated; nothing of it may be in use.
  void reset();

  class Use {
   public:
    explicit Use(NumericMemory& memory);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
  };

 private:
  static void* allocate(std::size_t size);
  static void* reallocate(void* data, std::size_t size);
  static void release(void* data);

  [[nodiscard]] bool owns(const void* data) const;

  static thread_local NumericMemory* active_;  ///< of the innermost Use; null: none

  std::unique_ptr<std::byte[]> block_;
  std::size_t capacity_ = 0;
  std::size_t used_ = 0;      ///< of the block
  std::size_t required_ = 0;  ///< what the block should have had since the last reset
};

}  // namespace mbs::csc_umfpack
