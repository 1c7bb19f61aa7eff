// --blas selects the libraries that are then really loaded, or says why it cannot.
#include "environment/blas.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "environment/environment.hpp"
#include "support/program.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;

const BlasPair& pair_called(const std::vector<BlasPair>& pairs, const std::string& name) {
  for (const BlasPair& pair : pairs) {
    if (pair.name == name) return pair;
  }
  throw std::out_of_range(name);
}

std::string null_bench(const std::string& blas) {
  return "bench four-bar:1 --implementation null --steps 1 --benchmark_min_time=0 "
         "--benchmark_format=json --blas " +
         blas;
}

TEST(BlasPairs, HaveNamesAndFilesOfTheirOwn) {
  std::set<std::string> names, files;
  for (const BlasPair& pair : blas_pairs()) {
    names.insert(pair.name);
    files.insert(pair.blas_file.string() + pair.lapack_file.string() + pair.preload.string());
  }
  EXPECT_EQ(names.size(), blas_pairs().size());
  EXPECT_EQ(files.size(), blas_pairs().size());
}

TEST(BlasPairs, MissingFilesAreNamedWithTheirPackages) {
  const fs::path root = test::temporary_path("lib");
  const auto pairs = blas_pairs(root);
  const BlasPair& atlas = pair_called(pairs, "atlas-reference");
  fs::create_directories(root / "atlas");
  std::ofstream(root / "atlas" / "libblas.so.3") << "";
  const std::string reason = why_unavailable(atlas);
  EXPECT_NE(reason.find((root / "lapack" / "liblapack.so.3").string()), std::string::npos);
  EXPECT_EQ(reason.find("libblas.so.3"), std::string::npos) << reason;
  EXPECT_NE(reason.find("apt-get install"), std::string::npos) << reason;
  EXPECT_NE(reason.find("liblapack3"), std::string::npos) << reason;
  fs::create_directories(root / "lapack");
  std::ofstream(root / "lapack" / "liblapack.so.3") << "";
  EXPECT_EQ(why_unavailable(atlas), "");
  fs::remove_all(root);
}

TEST(LoaderEnvironment, PutsThePairFirstAndKeepsTheRest) {
  const auto pairs = blas_pairs("/r");
  using Changes = std::vector<std::pair<std::string, std::string>>;
  const BlasPair& own = pair_called(pairs, "openblas");
  EXPECT_EQ(loader_environment(own, "", ""), (Changes{{"LD_LIBRARY_PATH", "/r/openblas-serial"}}));
  EXPECT_EQ(loader_environment(own, "/opt:/x", ""),
            (Changes{{"LD_LIBRARY_PATH", "/r/openblas-serial:/opt:/x"}}));
  EXPECT_EQ(loader_environment(own, "/r/openblas-serial:/opt", ""), Changes{});
  EXPECT_EQ(loader_environment(own, "/r/openblas-serial-other", "").size(), 1U);
  const BlasPair& flame = pair_called(pairs, "blis-flame");
  EXPECT_EQ(loader_environment(flame, "", "/p.so"),
            (Changes{{"LD_LIBRARY_PATH", "/r/lapack:/r/blis-serial"},
                     {"LD_PRELOAD", "/r/libflame.so.1:/p.so"}}));
}

TEST(LoaderEnvironment, EffectIsJudgedByTheMappedFiles) {
  const fs::path root = fs::weakly_canonical(test::temporary_path("lib"));
  const std::vector<BlasPair> all = blas_pairs(root);
  const BlasPair pair = pair_called(all, "atlas-reference");
  for (const fs::path& file : {pair.blas_file, pair.lapack_file}) {
    fs::create_directories(file.parent_path());
    std::ofstream(file.string() + ".10") << "";
    fs::create_symlink(file.string() + ".10", file);
  }
  const std::string blas = pair.blas_file.string() + ".10";
  const std::string lapack = pair.lapack_file.string() + ".10";
  EXPECT_EQ(why_not_in_effect(pair, all, {blas, lapack}), "");
  EXPECT_NE(
      why_not_in_effect(pair, all, {lapack, "/usr/lib/other/libblas.so.3"}).find("not loaded"),
      std::string::npos);
  const std::string other = pair_called(all, "openblas").lapack_file;
  EXPECT_NE(why_not_in_effect(pair, all, {blas, lapack, other}).find(other + " is loaded too"),
            std::string::npos);
  for (const char* foreign : {"/lib/openblas-pthread/libopenblasp-r0.3.21.so", "/opt/libmkl_rt.so"}) {
    EXPECT_NE(why_not_in_effect(pair, all, {blas, lapack, foreign}).find(foreign),
              std::string::npos);
  }
  fs::remove_all(root);
}

TEST(ForeignBlas, IsAnotherMakersOrAnotherBuild) {
  const std::string blas = "/r/openblas-serial/libblas.so.3", lapack = "/r/lapack/liblapack.so.3";
  const std::string openblas = "/r/openblas-serial/libopenblas-r0.3.21.so";  // the BLAS needs it
  const std::string other = "/r/openblas-pthread/libopenblasp-r0.3.21.so";
  const std::string goto2 = "/opt/libgoto2.so";
  EXPECT_EQ(why_foreign({blas, lapack}, {blas, lapack, openblas}), "");
  EXPECT_TRUE(why_foreign({blas, lapack}, {blas, lapack, openblas, other}).starts_with(other));
  EXPECT_TRUE(why_foreign({blas, lapack}, {goto2, blas, lapack, openblas}).starts_with(goto2));
  EXPECT_TRUE(why_foreign({}, {openblas}).starts_with(openblas));
  const std::string atlas = "/r/atlas/libblas.so.3.10.3";
  EXPECT_EQ(why_foreign({atlas, lapack}, {atlas, lapack, "/r/libatlas.so.3.10.3"}), "");
}

TEST(AskedBlas, IsFoundAnywhereInTheCommandLine) {
  const auto asked = [](std::vector<const char*> arguments) {
    return asked_blas(static_cast<int>(arguments.size()), arguments.data());
  };
  EXPECT_EQ(asked({"mbs", "bench", "--blas", "atlas", "four-bar:1"}), "atlas");
  EXPECT_EQ(asked({"mbs", "bench", "--blas=atlas"}), "atlas");
  EXPECT_EQ(asked({"mbs", "--blas"}), std::nullopt);
  EXPECT_EQ(asked({"mbs", "bench"}), std::nullopt);
}

/// Every pair: either its very files are loaded and no other BLAS or LAPACK of the study's, or the
/// program ends with the packages to install.
TEST(BlasSelection, TakesEffectOrIsRefused) {
  for (const BlasPair& pair : blas_pairs()) {
    SCOPED_TRACE(pair.name);
    const auto run = test::run_mbs(null_bench(pair.name));
    if (!why_unavailable(pair).empty()) {
      EXPECT_EQ(run.status, 2);
      EXPECT_NE(run.errors.find("apt-get install"), std::string::npos) << run.errors;
      continue;
    }
#if MBS_SANITIZE
    if (!pair.preload.empty()) continue;  // the address sanitizer wants to be loaded first
#endif
    ASSERT_EQ(run.status, 0) << run.errors;
    const auto context = nlohmann::json::parse(run.output).at("context");
    EXPECT_EQ(context.at("blas"), pair.name);
    const std::string loaded = context.at("blas_loaded");
    EXPECT_NE(loaded.find(fs::canonical(pair.blas_file).string()), std::string::npos) << loaded;
    EXPECT_NE(loaded.find(fs::canonical(pair.lapack_file).string()), std::string::npos) << loaded;
    for (const BlasPair& other : blas_pairs()) {
      for (const fs::path& file : {other.blas_file, other.lapack_file}) {
        if (file == pair.blas_file || file == pair.lapack_file || !fs::exists(file)) continue;
        EXPECT_EQ(loaded.find(fs::canonical(file).string()), std::string::npos) << loaded;
      }
    }
  }
}

TEST(BlasSelection, UnknownNamesAreAnsweredWithTheKnownOnes) {
  for (const char* command : {"bench", "check", "simulate four-bar:1 --implementation x"}) {
    const auto run = test::run_mbs(std::string(command) + " --blas mkl");
    EXPECT_EQ(run.status, 2) << command;
    EXPECT_NE(run.errors.find("openblas-reference"), std::string::npos) << run.errors;
  }
  EXPECT_EQ(test::run_mbs("bench four-bar:1 --blas").status, 2);
}

TEST(BlasSelection, WithoutItTheSystemDecides) {
  const auto run = test::run_mbs(
      "bench four-bar:1 --implementation null --steps 1 --benchmark_min_time=0 "
      "--benchmark_format=json");
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(nlohmann::json::parse(run.output).at("context").at("blas"), "system");
}

TEST(BlasSelection, WithoutItALibraryBesideTheSystemsIsRefused) {
  const BlasPair& flame = pair_called(blas_pairs(), "blis-flame");
  if (!why_unavailable(flame).empty()) GTEST_SKIP() << why_unavailable(flame);
  const auto run = test::run_mbs("list", "LD_PRELOAD=" + flame.preload.string());
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("libflame"), std::string::npos) << run.errors;
}

}  // namespace
}  // namespace mbs
