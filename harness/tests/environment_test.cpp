// One thread whatever the environment says, and a record that says what but not where or who.
#include "environment/environment.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "environment/build_info.hpp"
#include "environment/machine.hpp"
#include "registry/registry.hpp"
#include "regular_expression.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

/// The context of a result of `mbs bench`, run under `environment`.
nlohmann::json context_under(const std::string& environment) {
  const auto run = test::run_mbs(
      "bench four-bar:1 --implementation null --steps 1 --benchmark_min_time=0 "
      "--benchmark_format=json",
      environment);
  EXPECT_EQ(run.status, 0) << run.errors;
  return nlohmann::json::parse(run.output).at("context");
}

std::string threads_under(const std::string& environment) {
  return context_under(environment).at("threads_environment");
}

/// Some machines tell OpenBLAS more than its kernels.
void forget_openblas_variables() {
  std::vector<std::string> names;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    if (text.starts_with("OPENBLAS_")) names.push_back(text.substr(0, text.find('=')));
  }
  for (const std::string& name : names) unsetenv(name.c_str());
}

TEST(SingleThread, OverrulesAHostileEnvironment) {
  forget_openblas_variables();
  const std::string one =
      "BLIS_NUM_THREADS=1 GOTO_NUM_THREADS=1 MKL_NUM_THREADS=1 OMP_NUM_THREADS=1 "
      "OPENBLAS_NUM_THREADS=1";
  // Which kernels OpenBLAS is told to take depends on the processor.
  const std::string told = "OPENBLAS_CORETYPE=Haswell ";
  const std::string wanted = std::string(one).insert(one.find("OPENBLAS"), told);
  EXPECT_EQ(threads_under("env -u OMP_NUM_THREADS " + told), wanted);
  EXPECT_EQ(threads_under(told + "OPENBLAS_NUM_THREADS=7"), wanted);
  EXPECT_EQ(threads_under(told + "OMP_NUM_THREADS=4,2 MKL_NUM_THREADS= BLIS_NUM_THREADS=1"),
            wanted);
}

TEST(SingleThread, IsNotSwitchedOffByAnInheritedGuard) {
  for (const char* guard : {"", "1", "12345"}) {
    EXPECT_NE(threads_under("OPENBLAS_NUM_THREADS=7 MBS_EXECUTED_AGAIN=" + std::string(guard))
                  .find("OPENBLAS_NUM_THREADS=1"),
              std::string::npos);
  }
}

TEST(SingleThread, KeepsArgumentsAndExitStatus) {
  const auto run = test::run_mbs("bench 'four-bar:1 2'", "OPENBLAS_NUM_THREADS=7");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("four-bar:1 2"), std::string::npos) << run.errors;
}

TEST(SingleThread, OpenBlasDoesNotFallBackToItsOldestKernels) {
  const std::string told = threads_under("env -u OPENBLAS_CORETYPE");
#if defined(__x86_64__)
  const auto name =
      reinterpret_cast<const char* (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  if (name != nullptr && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    const bool unknown = std::string(name()) == "Prescott" && !std::getenv("OPENBLAS_CORETYPE");
    EXPECT_EQ(told.find("OPENBLAS_CORETYPE=") != std::string::npos, unknown) << name() << told;
  }
#endif
  EXPECT_NE(threads_under("OPENBLAS_CORETYPE=Prescott").find("OPENBLAS_CORETYPE=Prescott"),
            std::string::npos);
}

TEST(SingleThread, RecordsOtherVariablesOfTheseLibraries) {
  EXPECT_NE(threads_under("OPENBLAS_CORETYPE=Haswell").find("OPENBLAS_CORETYPE=Haswell"),
            std::string::npos);
}

TEST(EnvironmentRecord, HasEveryKeyOnceAndNothingEmpty) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : environment_record()) {
    keys.push_back(key);
    // Without an available library there may be none to name, and CI may have set no variable.
    if (key != "blas_loaded" && key != "libraries" && key != "threads_environment") {
      EXPECT_FALSE(value.empty()) << key;
    }
  }
  EXPECT_EQ(keys,
            (std::vector<std::string>{"mbs_version", "commit", "dirty", "compiler", "flags",
                                      "build_type", "blas", "blas_loaded", "libraries", "cpu_model",
                                      "machine", "kernel", "threads_environment", "command"}));
}

TEST(EnvironmentRecord, NamesTheCommitAndTheBuild) {
  const BuildInfo& build = build_info();
  const std::string commit = build.commit, dirty = build.dirty;
  EXPECT_TRUE(RegularExpression("^([0-9a-f]{40}|unknown)$").found_in(commit)) << commit;
  const bool known = std::filesystem::exists(MBS_ROOT "/.git") &&
                     std::system("git --version > /dev/null 2>&1") == 0;
  EXPECT_EQ(commit != "unknown", known) << commit;
  EXPECT_TRUE(dirty == "true" || dirty == "false" || dirty == "unknown") << dirty;
  EXPECT_NE(std::string(build.flags).find("-std=c++20"), std::string::npos) << build.flags;
#if MBS_SANITIZE
#if !defined(__SANITIZE_ADDRESS__)
#error "the sanitize preset was asked for, and the address sanitizer is off"
#endif
  EXPECT_NE(std::string(build.flags).find("undefined"), std::string::npos) << build.flags;
  EXPECT_NE(std::string(build.flags).find("-fsanitize="), std::string::npos) << build.flags;
#endif
  EXPECT_TRUE(RegularExpression("^[[:alnum:]]+ [0-9.]+$").found_in(build.compiler)) << build.compiler;
}

TEST(EnvironmentRecord, NamesTheLibrariesOfAllAvailableImplementations) {
  std::string libraries;
  for (const auto& [key, value] : environment_record()) {
    if (key == "libraries") libraries = value;
  }
  for (const NamedVariant& variant : all_variants()) {
    const Implementation& implementation = variant.entry->implementation;
    const std::string named = implementation.library + " " + implementation.version;
    EXPECT_EQ(libraries.find(named) == std::string::npos, implementation.library == "none")
        << libraries;
  }
}

TEST(EnvironmentRecord, GivesNeitherHostNorHome) {
  std::array<char, 256> host{};
  ASSERT_EQ(gethostname(host.data(), host.size() - 1), 0);
  const std::string home = "/home/somebody/secret";
  const auto context = context_under("HOME=" + home + " OPENBLAS_COMMENT=" + home + "/blas");
  EXPECT_EQ(context.dump().find("somebody"), std::string::npos) << context;
  EXPECT_FALSE(context.contains("host_name"));
  for (const auto& value : context) EXPECT_NE(value, std::string(host.data()));
}

TEST(Machine, FingerprintIsShortAndStable) {
  EXPECT_TRUE(RegularExpression("^[0-9a-f]{12}$").found_in(machine_fingerprint()));
  EXPECT_EQ(machine_fingerprint(), machine_fingerprint());
  EXPECT_FALSE(cpu_model().empty());
}

TEST(BlasFiles, AreThoseMappedOnceEach) {
  const std::string maps =
      "7f1 r--p 0 fe:00 1  /usr/lib/x86_64-linux-gnu/openblas-serial/libopenblas-r0.3.21.so\n"
      "7f2 r-xp 0 fe:00 1  /usr/lib/x86_64-linux-gnu/openblas-serial/libopenblas-r0.3.21.so\n"
      "7f3 r-xp 0 fe:00 2  /usr/lib/libm.so.6\n"
      "7f4 rw-p 0 00:00 0 \n"
      "7f5 rw-p 0 00:00 0  [heap]\n"
      "7f6 r-xp 0 fe:00 3  /opt/a b/liblapack.so.3\n"
      "7f7 r-xp 0 fe:00 4  /opt/blas/libother.so\n"
      "7f8 r-xp 0 fe:00 5  /opt/intel/libmkl_core.so.2\n";
  EXPECT_EQ(
      blas_files(maps),
      (std::vector<std::string>{"/opt/a b/liblapack.so.3", "/opt/intel/libmkl_core.so.2",
                                "/usr/lib/x86_64-linux-gnu/openblas-serial/libopenblas-r0.3.21.so"}));
}

TEST(CommandLine, IsRepeatableButNamesNoFolders) {
  EXPECT_EQ(command_line({"/build/here/mbs", "bench", "four-bar:4", "--benchmark_filter=a b",
                          "--benchmark_out=/somewhere/else/x.json", "/some/scene.json", ""}),
            "mbs bench four-bar:4 '--benchmark_filter=a b' --benchmark_out=x.json scene.json ''");
  const std::string here = (std::filesystem::current_path() / "results" / "x.json").string();
  EXPECT_EQ(command_line({"mbs", "--json", here}), "mbs --json results/x.json");
  EXPECT_EQ(command_line({"mbs", "simulate", "it's.json"}), R"(mbs simulate 'it'\''s.json')");
}

TEST(WithoutHome, ReplacesHomesOnly) {
  const char* home = std::getenv("HOME");
  if (home != nullptr && std::string(home).size() > 1) {
    EXPECT_EQ(without_home(std::string(home) + "/x"), "~/x");
  }
  EXPECT_EQ(without_home("/home/alice/lib;/usr/lib /Users/bob"), "~/lib;/usr/lib ~");
  EXPECT_EQ(without_home("-I/home/a:-I/Users/home/x /home/"), "-I~:-I~/x /home/");
  EXPECT_EQ(without_home("/usr/home-made"), "/usr/home-made");
}

}  // namespace
}  // namespace mbs
