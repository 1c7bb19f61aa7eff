// A SAX handler that builds the value and refuses duplicate keys and deep nesting.
#include "scene_file/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

using nlohmann::json;

/// Builds the value. Every handler returns true: a fault throws UsageError.
class StrictBuilder : public nlohmann::json_sax<json> {
 public:
  StrictBuilder(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  json take() { return std::move(root_); }

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(number_integer_t value) override { return put(value); }
  bool number_unsigned(number_unsigned_t value) override { return put(value); }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return put(value); }
  bool string(string_t& value) override { return put(std::move(value)); }
  bool binary(binary_t& /*value*/) override { return false; }  // JSON text has none
  bool start_object(std::size_t /*size*/) override { return open(json::object()); }
  bool start_array(std::size_t /*size*/) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    Level& level = levels_.back();
    if (level.container->contains(value)) {
      fail(fmt::format("{}: found this key twice in one object, allowed is once",
                       path_of_key(path(), value)));
    }
    level.key = std::move(value);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*last_token*/,
                   const json::exception& error) override {
    // "[json.exception...] parse error at line 1, column 2: reason", where not every error has the
    // middle part: keep the reason and say where ourselves.
    std::string_view reason = error.what();
    reason.remove_prefix(std::min(reason.find("] ") + 2, reason.size()));
    if (reason.starts_with("parse error")) reason.remove_prefix(reason.find(": ") + 2);
    fail_at(position == 0 ? 0 : position - 1, reason);
  }

  /// What the parser does not look at: what follows a NUL, which ends the text for it, and
  /// comments.
  void check_bytes() const {
    const std::size_t nul = text_.find('\0'), bad = first_ill_formed(text_);
    if (nul < bad) fail_at(nul, "a NUL byte; allowed is text");
    if (bad != std::string_view::npos) fail_at(bad, "ill-formed UTF-8 byte");
  }

 private:
  struct Level {
    json* container;
    std::string key;  // of the member being read, if the container is an object
  };

  [[noreturn]] void fail_at(std::size_t byte, std::string_view reason) const {
    const std::string_view read = text_.substr(0, byte);
    const auto line = std::count(read.begin(), read.end(), '\n') + 1;
    const auto newline = read.rfind('\n');
    const std::size_t column =
        newline == std::string_view::npos ? read.size() + 1 : read.size() - newline;
    fail(fmt::format("malformed JSON at line {}, column {}: {}", line, column,
                     printable(reason, 300)));
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw UsageError(fmt::format("{}: {}", printable(where_), what));
  }

  /// Path of the innermost open container.
  std::string path() const {
    std::string result;
    for (std::size_t i = 0; i + 1 < levels_.size(); ++i) {
      const json& container = *levels_[i].container;
      result = container.is_array() ? path_of_item(result, container.size() - 1)
                                    : path_of_key(result, levels_[i].key);
    }
    return result;
  }

  /// Stores a value where the text is; the result stays in place while it is open.
  json* store(json value) {
    if (levels_.empty()) return &(root_ = std::move(value));
    json& container = *levels_.back().container;
    if (container.is_object()) return &(container[levels_.back().key] = std::move(value));
    container.push_back(std::move(value));
    return &container.back();
  }

  template <typename T>
  bool put(T&& value) {
    store(json(std::forward<T>(value)));
    return true;
  }

  bool open(json container) {
    if (levels_.size() == kDeepestNesting) {
      fail(fmt::format("{}: nested too deeply, allowed are {} levels", path(), kDeepestNesting));
    }
    levels_.push_back({store(std::move(container)), {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  std::string_view text_;
  const std::string& where_;
  json root_;
  std::vector<Level> levels_;
};

}  // namespace

json parse_json(std::string_view text, const std::string& where) {
  if (text.empty()) {
    throw UsageError(printable(where) + ": the file is empty, allowed is a JSON scene");
  }
  StrictBuilder builder(text, where);
  json::sax_parse(text, &builder, json::input_format_t::json, /*strict=*/true,
                  /*ignore_comments=*/true);
  builder.check_bytes();
  return builder.take();
}

std::string path_of_key(const std::string& path, std::string_view key) {
  return path.empty() ? printable(key) : path + '.' + printable(key);
}

std::string path_of_item(const std::string& path, std::size_t index) {
  return path + '[' + std::to_string(index) + ']';
}

}  // namespace mbs
