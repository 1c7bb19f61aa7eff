// Parallel regions of a library on one thread, and of everyone else as the runtime has them.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "registry/registry.hpp"

namespace mbs {
namespace {

using Parallel = void (*)(void (*)(void*), void*, unsigned, unsigned);

bool has_supernodal() {
  for (const auto& one : all_variants()) {
    if (one.name == "csc_cholmod/supernodal") return true;
  }
  return false;
}

// CHOLMOD is bound to the definition in this program, not to the runtime's: for teams of one that
// makes a system call at each supernode.
TEST(OpenMp, TheSupernodalCodeEntersRegionsThroughThisProgram) {
  const void* entered = dlsym(RTLD_DEFAULT, "GOMP_parallel");
  if (!has_supernodal() || dlsym(RTLD_DEFAULT, "omp_get_thread_num") == nullptr) {
    GTEST_SKIP() << "no CHOLMOD on GCC's OpenMP";
  }
  Dl_info where{};
  ASSERT_NE(dladdr(entered, &where), 0);
  EXPECT_EQ(std::string(where.dli_fname).find("gomp"), std::string::npos) << where.dli_fname;
}

TEST(OpenMp, OtherCallersGetTheirTeams) {
  const auto parallel = reinterpret_cast<Parallel>(dlsym(RTLD_DEFAULT, "GOMP_parallel"));
  if (parallel == nullptr) GTEST_SKIP() << "no OpenMP";
  static std::mutex guard;
  static std::set<std::thread::id> threads;
  parallel(
      [](void*) {
        const std::lock_guard lock(guard);
        threads.insert(std::this_thread::get_id());
      },
      nullptr, 2, 0);
  EXPECT_EQ(threads.size(), 2u);
}

}  // namespace
}  // namespace mbs
