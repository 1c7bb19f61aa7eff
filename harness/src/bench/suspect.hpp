// Who was running when a signal ended the process.
#pragma once

#include <string_view>

namespace mbs {

/// While it lives, a signal that ends the process (SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL,
/// SIGTERM) first writes one line to standard error, without " in NAME" if nobody is named:
///
///   mbs bench: ended by SIGSEGV in folder/variant/scene
///
/// The process then ends by that signal as it would have. One object at a time.
class SuspectWatch {
 public:
  SuspectWatch();
  ~SuspectWatch();
  SuspectWatch(const SuspectWatch&) = delete;
  SuspectWatch& operator=(const SuspectWatch&) = delete;
};

/// Who runs from now on; empty: nobody. Cheap, and without allocation.
void name_suspect(std::string_view name);

}  // namespace mbs
