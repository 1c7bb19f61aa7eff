// The error that a user can mend: printed as one line, exit status 2.
#pragma once

#include <stdexcept>

namespace mbs {

/// Bad input: what, where, and what is allowed, in one line.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace mbs
