#include "regular_expression.hpp"

#include "usage_error.hpp"

namespace mbs {

RegularExpression::RegularExpression(const std::string& pattern) {
  const int error = regcomp(&compiled_, pattern.c_str(), REG_EXTENDED | REG_NOSUB);
  if (error == 0) return;
  std::string message(regerror(error, &compiled_, nullptr, 0), '\0');
  regerror(error, &compiled_, message.data(), message.size());
  message.pop_back();  // the zero at its end
  throw UsageError(message);
}

RegularExpression::~RegularExpression() { regfree(&compiled_); }

bool RegularExpression::found_in(const std::string& text) const {
  return regexec(&compiled_, text.c_str(), 0, nullptr, 0) == 0;
}

}  // namespace mbs
