// Implementations share nothing but the harness's public headers, the list names them all, and
// nobody else reads theirs.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "registry/registry.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = MBS_ROOT;
const fs::path kImplementations = kRoot / "implementations";

/// The folders with an implementation.
std::vector<fs::path> folders() {
  std::vector<fs::path> result;
  for (const auto& item : fs::directory_iterator(kImplementations)) {
    if (item.is_directory() && fs::exists(item.path() / "CMakeLists.txt")) {
      result.push_back(item.path());
    }
  }
  std::ranges::sort(result);
  return result;
}

bool is_file_below(const fs::path& folder, const std::string& name) {
  return fs::is_regular_file(folder / name);
}

/// `text` without its continued lines.
std::string joined(const std::string& text) {
  if (text.find("\\\n") == std::string::npos) return text;
  return std::regex_replace(text, std::regex("\\\\\n"), "");
}

/// The arguments of all #include directives in joined `text`, with their quotes, as they stand.
std::vector<std::string> includes(const std::string& text) {
  static const std::regex directive(
      R"re(\s*(?:#|%:|\?\?=)(?:\s|/\*.*?\*/)*(?:include|import|include_next)\b(.*))re");
  std::vector<std::string> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    // Expressions are slow: only where they may match.
    if (line.find("include") == std::string::npos && line.find("import") == std::string::npos) {
      continue;
    }
    std::smatch match;
    if (std::regex_match(line, match, directive)) found.push_back(match[1]);
  }
  return found;
}

/// Why a file in `folder` may not include `name`, written in "..." if `quoted`, else in <...>.
/// Empty if it may.
std::string objection(const fs::path& folder, const std::string& name, bool quoted) {
  const fs::path path(name);
  if (path.is_absolute() || std::ranges::find(path, "..") != path.end()) {
    return "leaves the folder";
  }
  if (name.starts_with("mbs/")) {
    return is_file_below(kRoot / "harness" / "include", name) ? "" : "is no public header";
  }
  if (quoted) return is_file_below(folder, name) ? "" : "is not in the folder";
  for (const fs::path& hidden : {kRoot, kRoot / "harness", kRoot / "harness" / "src",
                                 kRoot / "harness" / "tests", kImplementations, folder}) {
    if (is_file_below(hidden, name)) return "is no system or library header";
  }
  return "";
}

/// Everything in `written`, a source file of `folder`, that breaks the rule; one line each.
std::vector<std::string> violations(const fs::path& folder, const std::string& written) {
  const std::string text = joined(written);
  std::vector<std::string> found;
  static const std::regex argument(R"re(\s*(?:"([^"]+)"|<([^>]+)>).*)re");
  for (const std::string& rest : includes(text)) {
    std::smatch name;
    if (!std::regex_match(rest, name, argument)) {
      found.push_back("#include" + rest + " names no file");
      continue;
    }
    const bool quoted = name[1].matched;
    const std::string file = quoted ? name[1] : name[2];
    const std::string why = objection(folder, file, quoted);
    if (!why.empty()) found.push_back(file + " " + why);
  }
  for (const fs::path& other : folders()) {
    const std::string name = other.filename().string();
    if (name == folder.filename() || text.find(name) == std::string::npos) continue;
    if (std::regex_search(text, std::regex("\\b" + name + "\\s*(::|\\{)"))) {
      found.push_back("names the implementation " + name);
    }
  }
  return found;
}

/// The same for a folder's CMakeLists.txt.
std::vector<std::string> build_violations(const fs::path& folder, const std::string& text) {
  std::vector<std::string> found;
  for (const char* way_out :
       {"..", "_SOURCE_DIR", "_BINARY_DIR", "mbs_harness", "implementation_"}) {
    std::string rest = text;
    const std::string own = "implementation_" + folder.filename().string();
    for (auto at = rest.find(own); at != std::string::npos; at = rest.find(own)) {
      rest.erase(at, own.size());
    }
    rest = std::regex_replace(rest, std::regex("mbs_implementation"), "");
    rest = std::regex_replace(rest, std::regex("\n\\s*#[^\n]*|^#[^\n]*"), "");
    if (rest.find(way_out) != std::string::npos) found.push_back(std::string("uses ") + way_out);
  }
  return found;
}

TEST(Independence, EveryImplementationKeepsTheRule) {
  int sources = 0;
  for (const fs::path& folder : folders()) {
    for (const auto& item : fs::recursive_directory_iterator(folder)) {
      if (!item.is_regular_file() || item.path().extension() == ".md") continue;
      const std::string text = test::file_text(item.path().string());
      const bool build_file = item.path().filename() == "CMakeLists.txt";
      const auto found = build_file ? build_violations(folder, text) : violations(folder, text);
      for (const std::string& line : found) ADD_FAILURE() << item.path() << ": " << line;
      if (!build_file) ++sources;
    }
  }
  EXPECT_GE(sources, 2 * static_cast<int>(folders().size())) << "too few files to believe it";
}

/// The implementations whose headers `text`, a source file outside of implementations/, includes.
std::vector<std::string> read_by(const std::string& text) {
  static const std::vector<fs::path> all = folders();
  const std::vector<std::string> files = includes(joined(text));
  std::vector<std::string> found;
  for (const fs::path& folder : all) {
    const std::string name = folder.filename().string();
    for (const std::string& file : files) {
      const auto at = file.find(name + "/");
      if (at == std::string::npos || at == 0) continue;
      if (std::string("\"</").find(file[at - 1]) != std::string::npos) found.push_back(name);
    }
  }
  return found;
}

/// Headers of implementations are their own: one study looks into one of them, with its solvers.
TEST(Independence, NobodyElseReadsTheirHeaders) {
  const fs::path exception = kRoot / "study" / "extremes" / "stale_pivots";
  int sources = 0, exceptional = 0;
  for (const fs::path& top : {kRoot / "harness", kRoot / "study"}) {
    for (const auto& item : fs::recursive_directory_iterator(top)) {
      const fs::path extension = item.path().extension();
      if (!item.is_regular_file() || (extension != ".cpp" && extension != ".hpp")) continue;
      ++sources;
      for (const std::string& name : read_by(test::file_text(item.path().string()))) {
        const bool allowed = item.path().parent_path() == exception && name == "csc_klu";
        exceptional += allowed;
        EXPECT_TRUE(allowed) << item.path() << " includes headers of " << name;
      }
    }
  }
  EXPECT_GT(sources, 200) << "too few files to believe it";
  EXPECT_GT(exceptional, 0) << "the exception is not needed any more";
}

/// A room of harness/src may be read without those that include it.
TEST(Independence, RoomsOfTheHarnessFormNoCircle) {
  const fs::path src = kRoot / "harness" / "src";
  std::map<std::string, std::set<std::string>> reached;  // by room; its own includes at first
  for (const auto& item : fs::recursive_directory_iterator(src)) {
    const std::string room = item.path().lexically_relative(src).begin()->string();
    if (!item.is_regular_file() || !fs::is_directory(src / room)) continue;
    for (const std::string& name : includes(joined(test::file_text(item.path().string())))) {
      const auto begin = name.find('"') + 1, end = name.find('/');
      if (begin == 0 || end == std::string::npos) continue;
      const std::string other = name.substr(begin, end - begin);
      if (other != room && fs::is_directory(src / other)) reached[room].insert(other);
    }
  }
  EXPECT_TRUE(reached["scene_file"].contains("scene")) << "includes are not seen";
  for (std::size_t pass = 0; pass < reached.size(); ++pass) {
    for (auto& [room, others] : reached) {
      for (const std::string& other : std::set(others)) others.merge(std::set(reached[other]));
    }
  }
  for (const auto& [room, others] : reached) {
    EXPECT_FALSE(others.contains(room)) << room << " includes itself by way of others";
  }
}

TEST(Independence, TheListAndTheFoldersAreTheSame) {
  std::vector<std::string> listed, present;
  for (const RegistryEntry& entry : registry()) listed.push_back(entry.folder);
  for (const fs::path& folder : folders()) present.push_back(folder.filename().string());
  std::ranges::sort(listed);
  EXPECT_EQ(listed, present) << "implementations/CMakeLists.txt against implementations/*/";
  EXPECT_FALSE(present.empty());
}

/// A folder to make sources up for; the files next to them are real.
fs::path some_folder() { return folders().front(); }

void expect_one_violation(const std::string& text, const std::string& reason) {
  const std::vector<std::string> found = violations(some_folder(), text);
  ASSERT_EQ(found.size(), 1U) << text;
  EXPECT_NE(found.front().find(reason), std::string::npos) << found.front();
}

TEST(Independence, AcceptsWhatIsAllowed) {
  EXPECT_EQ(
      violations(some_folder(),
                 "// First line.\n#pragma once\n#include <vector>\n#include <Eigen/Core>\n"
                 "  #  include \"mbs/model.hpp\"  // why\n#include \"simulation.hpp\"\n"
                 "// the text #include \"run/run.hpp\" in a comment, not at a line's start\n"),
      std::vector<std::string>{});
}

TEST(Independence, FindsOffendersInMadeUpText) {
  const std::string other = folders().back().filename().string();
  ASSERT_NE(folders().back(), some_folder()) << "two folders are needed";
  expect_one_violation("#include \"run/run.hpp\"\n", "is not in the folder");
  expect_one_violation("#include \"mbs/bench_command.hpp\"\n", "is no public header");
  expect_one_violation("#include <mbs/bench_command.hpp>\n", "is no public header");
  expect_one_violation("#include <run/run.hpp>\n", "is no system or library header");
  expect_one_violation("#include <simulation.hpp>\n", "is no system or library header");
  expect_one_violation("#include <harness/src/run/run.hpp>\n", "is no system or library header");
  expect_one_violation("#include <" + other + "/simulation.hpp>\n", "no system or library header");
  expect_one_violation("#include \"../" + other + "/simulation.hpp\"\n", "leaves the folder");
  expect_one_violation("#include <mbs/../../src/run/run.hpp>\n", "leaves the folder");
  expect_one_violation("#include \"" + (kRoot / "harness/src/run/run.hpp").string() + "\"\n",
                       "leaves the folder");
  expect_one_violation("#define HEADER \"run/run.hpp\"\n#include HEADER\n", "names no file");
  expect_one_violation("int x;\n# /* y */ include \"run/run.hpp\"\n", "is not in the folder");
  expect_one_violation("#inc\\\nlude \"run/run.hpp\"\n", "is not in the folder");
  expect_one_violation("%:include \"run/run.hpp\"\n", "is not in the folder");
  expect_one_violation("namespace mbs::" + other + " {\nclass Solver;\n}\n", "names the impl");
  expect_one_violation("auto x = mbs::" + other + "::implementation();\n", "names the impl");
}

TEST(Independence, FindsReadersInMadeUpText) {
  const std::string name = some_folder().filename().string();
  for (const std::string& file : {"<" + name + "/solver.hpp>", "\"" + name + "/solver.hpp\"",
                                  "\"../../implementations/" + name + "/solver.hpp\""}) {
    EXPECT_EQ(read_by("#include " + file + "\n"), std::vector<std::string>{name}) << file;
  }
  EXPECT_TRUE(read_by("// " + name + "/\n#include \"mbs/model.hpp\"\n").empty());
}

TEST(Independence, FindsOffendersInMadeUpBuildFiles) {
  EXPECT_EQ(build_violations("x/foo",
                             "mbs_implementation(SOURCES implementation.cpp)\n"
                             "target_compile_definitions(implementation_foo PRIVATE A)\n"),
            std::vector<std::string>{});
  for (const char* line : {"mbs_implementation(SOURCES ../bar/solver.cpp)",
                           "include_directories(${PROJECT_SOURCE_DIR}/harness/src)",
                           "target_link_libraries(implementation_foo PRIVATE mbs_harness)",
                           "mbs_implementation(SOURCES a.cpp LIBRARIES implementation_bar)"}) {
    EXPECT_EQ(build_violations("x/foo", line).size(), 1U) << line;
  }
}

}  // namespace
}  // namespace mbs
