// Text from outside, made fit for a one-line message.
#pragma once

#include <string>
#include <string_view>

namespace mbs {

/// `text` on one line and at most about `longest` bytes long ("..." marks a cut): control
/// characters and bytes that are not UTF-8 become \xNN.
std::string printable(std::string_view text, std::size_t longest = 160);

/// Where the first byte is that is not UTF-8; npos: none.
std::size_t first_ill_formed(std::string_view text);

/// The same as printable() in double quotes.
std::string in_quotes(std::string_view text);

}  // namespace mbs
