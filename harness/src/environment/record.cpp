// Collects the environment record.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

#include "environment/blas.hpp"
#include "environment/build_info.hpp"
#include "environment/environment.hpp"
#include "environment/machine.hpp"
#include "printable.hpp"
#include "registry/registry.hpp"
#include "regular_expression.hpp"

extern char** environ;

namespace mbs {
namespace {

std::string whole_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void add_once(std::vector<std::string>& list, const std::string& item) {
  if (std::ranges::find(list, item) == list.end()) list.push_back(item);
}

/// "Eigen 3.4.0; KLU 1.3.9" of the implementations in this build.
std::string libraries() {
  std::vector<std::string> names;
  for (const RegistryEntry& entry : registry()) {
    if (!entry.unavailable.empty() || entry.implementation.library == "none") continue;
    add_once(names, entry.implementation.library + " " + entry.implementation.version);
  }
  return fmt::format("{}", fmt::join(names, "; "));
}

/// Every variable that speaks to a BLAS or an OpenMP runtime, not only those that are forced.
std::string threads_environment() {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    for (const char* prefix : {"OMP_", "OPENBLAS_", "GOTO_", "BLIS_", "MKL_"}) {
      if (text.starts_with(prefix)) variables.push_back(text);
    }
  }
  std::ranges::sort(variables);
  return without_home(fmt::format("{}", fmt::join(variables, " ")));
}

std::vector<std::string> own_arguments() {
  std::istringstream stream(whole_file("/proc/self/cmdline"));
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(stream, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

/// An absolute path as its part below the working directory, else as its last part.
std::string shortened(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path relative = fs::path(path).lexically_relative(fs::current_path(error));
  if (!error && !relative.empty() && *relative.begin() != "..") return relative.string();
  const fs::path name = fs::path(path).lexically_normal().filename();
  return name.empty() ? path : name.string();
}

std::string blas_asked(const std::vector<std::string>& arguments) {
  std::vector<const char*> pointers;
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  return asked_blas(static_cast<int>(pointers.size()), pointers.data()).value_or("system");
}

}  // namespace

std::string without_home(std::string text) {
  std::vector<std::string> homes;
  if (const char* home = std::getenv("HOME")) homes.emplace_back(home);
  if (const passwd* user = getpwuid(getuid())) homes.emplace_back(user->pw_dir);
  for (std::string home : homes) {
    while (!home.empty() && home.back() == '/') home.pop_back();
    if (home.empty()) continue;
    for (auto at = text.find(home); at != std::string::npos; at = text.find(home, at + 1)) {
      const char next = at + home.size() < text.size() ? text[at + home.size()] : '/';
      if (!std::isalnum(static_cast<unsigned char>(next))) text.replace(at, home.size(), 1, '~');
    }
  }
  for (auto at = text.find('/'); at != std::string::npos; at = text.find('/', at + 1)) {
    for (const std::string_view folder : {"/home/", "/Users/"}) {
      const std::size_t name = at + folder.size();
      const std::size_t end = std::min(text.find_first_of("/;: \t\n\v\f\r", name), text.size());
      if (text.compare(at, folder.size(), folder) != 0 || end <= name) continue;
      text.replace(at, end - at, 1, '~');
    }
  }
  return text;
}

std::string command_line(const std::vector<std::string>& arguments) {
  std::string line;
  for (std::string argument : arguments) {
    const auto equals = argument.find('=');
    const bool option = argument.starts_with("--") && equals != std::string::npos;
    const std::size_t value = option ? equals + 1 : 0;
    const bool program = line.empty();
    if (program) {
      argument = std::filesystem::path(argument).filename().string();
    } else if (argument.compare(value, 1, "/") == 0) {
      argument = argument.substr(0, value) + shortened(argument.substr(value));
    }
    if (argument.empty() || argument.find_first_of(" \t\n'\"\\$&|;()<>*?[]") != std::string::npos) {
      std::string quoted;
      for (const char one : argument) quoted += one == '\'' ? R"('\'')" : std::string(1, one);
      argument = fmt::format("'{}'", quoted);
    }
    line += (line.empty() ? "" : " ") + argument;
  }
  return without_home(line);
}

std::vector<std::string> blas_files(const std::string& maps) {
  static const RegularExpression name("/lib[^/]*(blas|lapack|mkl|blis|goto|atlas|flame|armpl)[^/]*$");
  std::vector<std::string> files;
  std::istringstream stream(maps);
  for (std::string line; std::getline(stream, line);) {
    const auto slash = line.find('/');
    if (slash == std::string::npos) continue;
    const std::string path = line.substr(slash);
    if (name.found_in(path)) add_once(files, path);
  }
  std::ranges::sort(files);  // the kernel puts a small file into a gap now and then: the same libraries, another order
  return files;
}

std::vector<std::string> loaded_blas_files() { return blas_files(whole_file("/proc/self/maps")); }

EnvironmentRecord environment_record() {
  const BuildInfo& build = build_info();
  const std::vector<std::string> arguments = own_arguments();
  EnvironmentRecord record{
      {"mbs_version", build.version},
      {"commit", build.commit},
      {"dirty", build.dirty},
      {"compiler", build.compiler},
      {"flags", without_home(build.flags)},
      {"build_type", build.build_type},
      {"blas", blas_asked(arguments)},
      {"blas_loaded", without_home(fmt::format("{}", fmt::join(loaded_blas_files(), ";")))},
      {"libraries", libraries()},
      {"cpu_model", cpu_model()},
      {"machine", machine_fingerprint()},
      {"kernel", kernel()},
      {"threads_environment", threads_environment()},
      {"command", command_line(arguments)},
  };
  // It ends up in JSON, and arguments and variables may hold any bytes.
  for (auto& [key, value] : record) value = printable(value, std::string::npos);
  return record;
}

}  // namespace mbs
