// The fuzz target on its corpus and on the shipped scenes, so that it stays true without a fuzzer.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>

#include "support/program.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

namespace mbs {
namespace {

TEST(FuzzCorpus, IsScenesOrOneLineEach) {
  int files = 0;
  for (const char* folder : {"harness/fuzz/corpus", "harness/scenes/examples", "harness/scenes"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(MBS_ROOT) / folder)) {
      if (entry.path().extension() != ".json") continue;
      SCOPED_TRACE(entry.path().string());
      const std::string text = test::file_text(entry.path());
      // It aborts at what should not be.
      EXPECT_EQ(
          LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()),
          0);
      ++files;
    }
  }
  EXPECT_GT(files, 5);
}

}  // namespace
}  // namespace mbs
