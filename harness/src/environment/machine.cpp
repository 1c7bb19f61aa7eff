// Reads /proc and /sys for the machine's identity.
#include "environment/machine.hpp"

#include <sched.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>

namespace mbs {
namespace {

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// Value of the first "key : value" line of a file in the manner of /proc; empty if there is none.
std::string value_of(const std::string& path, std::string_view key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(':');
    if (colon == std::string::npos) continue;
    const auto last = line.find_last_not_of(" \t", colon == 0 ? 0 : colon - 1);
    if (std::string_view(line).substr(0, last + 1) != key) continue;
    const auto begin = line.find_first_not_of(" \t", colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return "";
}

/// "1 Data 32K, 1 Instruction 32K, ..." of the first processor.
std::string caches() {
  std::string result;
  for (int index = 0;; ++index) {
    const std::string folder = fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/", index);
    const std::string level = first_line(folder + "level");
    if (level.empty()) return result;
    result += level + " " + first_line(folder + "type") + " " + first_line(folder + "size") + ", ";
  }
}

/// The kernel reserves a little more or less from one release to the next; whole GiB do not change.
long memory_gib() {
  const double pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
  return std::lround(pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024 * 1024));
}

/// FNV-1a, 64 bits: stable from one run, compiler and standard library to the next.
std::uint64_t hash(std::string_view text) {
  std::uint64_t value = 0xcbf29ce484222325;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return value;
}

utsname system_name() {
  utsname name{};
  uname(&name);
  return name;
}

}  // namespace

std::string cpu_model() {
  const std::string cpuinfo = "/proc/cpuinfo";
  const std::string name = value_of(cpuinfo, "model name");
  if (name.empty()) return fmt::format("unknown {}", system_name().machine);
  return fmt::format("{} (family {}, model {}, stepping {})", name, value_of(cpuinfo, "cpu family"),
                     value_of(cpuinfo, "model"), value_of(cpuinfo, "stepping"));
}

std::string kernel() {
  const utsname name = system_name();
  return fmt::format("{} {}", name.sysname, name.release);
}

std::string machine_fingerprint() {
  const std::string identity =
      fmt::format("{}; {} processors; {}{} GiB; {}", cpu_model(), sysconf(_SC_NPROCESSORS_ONLN),
                  caches(), memory_gib(), system_name().machine);
  return fmt::format("{:016x}", hash(identity)).substr(0, 12);
}

void stay_on_this_processor() {
  const int here = sched_getcpu();
  if (here < 0) return;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(here, &set);
  sched_setaffinity(0, sizeof(set), &set);  // where that is not permitted, times are still times
}

}  // namespace mbs
