// Regular expressions by the C library: those of the standard library take seconds to compile in each file that has them.
#pragma once

#include <regex.h>

#include <string>

namespace mbs {

/// An extended one of POSIX.
class RegularExpression {
 public:
  /// Throws UsageError, which says what is wrong with `pattern`.
  explicit RegularExpression(const std::string& pattern);
  ~RegularExpression();
  RegularExpression(const RegularExpression&) = delete;
  RegularExpression& operator=(const RegularExpression&) = delete;

  /// Whether any part of `text` matches.
  [[nodiscard]] bool found_in(const std::string& text) const;

 private:
  regex_t compiled_;
};

}  // namespace mbs
