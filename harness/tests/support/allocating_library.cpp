// Allocates from within a shared library: the positive control of the allocation counter.
#include <cstdlib>
#include <new>

extern "C" void* malloc_in_library(std::size_t bytes) { return std::malloc(bytes); }
extern "C" void* new_in_library(std::size_t bytes) { return ::operator new(bytes); }
