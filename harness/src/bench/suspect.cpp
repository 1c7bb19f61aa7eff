// A handler that calls nothing but write(2), sigaction(2) and raise(3).
#include "bench/suspect.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <utility>

namespace mbs {
namespace {

// Static, since a heap that a contender has damaged must not matter.
constexpr std::size_t kLongestName = 500;
std::array<char, kLongestName> suspect_name;
volatile std::sig_atomic_t suspect_length = 0;
alignas(64) std::array<char, 65536> signal_stack;

constexpr std::array<std::pair<int, std::string_view>, 6> kSignals{{{SIGSEGV, "SIGSEGV"},
                                                                    {SIGABRT, "SIGABRT"},
                                                                    {SIGFPE, "SIGFPE"},
                                                                    {SIGBUS, "SIGBUS"},
                                                                    {SIGILL, "SIGILL"},
                                                                    {SIGTERM, "SIGTERM"}}};
std::array<struct sigaction, kSignals.size()> usual;  // what each signal does without the watch

void tell_suspect(int signal) {
  std::array<char, kLongestName + 64> line;
  std::size_t length = 0;
  const auto add = [&](std::string_view text) {
    std::memcpy(line.data() + length, text.data(), text.size());
    length += text.size();
  };
  add("mbs bench: ended by ");
  for (const auto& [number, name] : kSignals) {
    if (number == signal) add(name);
  }
  if (suspect_length > 0) {
    add(" in ");
    add({suspect_name.data(), static_cast<std::size_t>(suspect_length)});
  }
  add("\n");
  if (::write(STDERR_FILENO, line.data(), length) < 0) {  // nowhere left to say so
  }
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (kSignals[i].first == signal) ::sigaction(signal, &usual[i], nullptr);
  }
  ::raise(signal);  // for who was there before, on return: files that are not whole are removed
}

}  // namespace

void name_suspect(std::string_view name) {
  suspect_length = 0;  // so that no signal finds half a name
  const std::size_t length = std::min(name.size(), kLongestName);
  if (length > 0) std::memcpy(suspect_name.data(), name.data(), length);
  suspect_length = static_cast<std::sig_atomic_t>(length);
}

SuspectWatch::SuspectWatch() {
  name_suspect("");
  stack_t stack{};  // of its own: the other one may be what has overflown
  stack.ss_sp = signal_stack.data();
  stack.ss_size = signal_stack.size();
  ::sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = tell_suspect;
  action.sa_flags = SA_ONSTACK;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i].first, &action, &usual[i]);
    if (usual[i].sa_handler == SIG_IGN) ::sigaction(kSignals[i].first, &usual[i], nullptr);
  }
}

SuspectWatch::~SuspectWatch() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i].first, &usual[i], nullptr);
  }
  stack_t stack{};
  stack.ss_flags = SS_DISABLE;
  ::sigaltstack(&stack, nullptr);
}

}  // namespace mbs
