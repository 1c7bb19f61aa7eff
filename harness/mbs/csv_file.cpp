// Formats rows.
#include "mbs/csv_file.hpp"

#include <fmt/format.h>

#include <iterator>

namespace mbs {
namespace {

std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
  std::string result = "\"";
  for (const char c : name) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

}  // namespace

CsvFile::CsvFile(const std::string& path, const std::vector<std::string>& columns) : file_(path) {
  std::string header;
  for (const std::string& column : columns) {
    if (!header.empty()) header += ',';
    header += quoted(column);
  }
  file_.stream() << header << '\n';
}

void CsvFile::write(std::span<const double> row) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) text.push_back(',');
    fmt::format_to(out, "{}", row[i]);
  }
  text.push_back('\n');
  file_.stream().write(text.data(), static_cast<std::streamsize>(text.size()));
}

}  // namespace mbs
