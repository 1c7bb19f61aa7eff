// Formats rows.
#include "mbs/csv_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mbs {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

}  // namespace

CsvFile::CsvFile(const std::string& path, const std::vector<std::string>& columns) : file_(path) {
  write(columns);
}

std::string csv_line(std::span<const std::string> row) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) line += ',';
    line += quoted(row[i]);
  }
  return line + '\n';
}

void CsvFile::write(std::span<const std::string> row) { file_.write(csv_line(row)); }

void CsvFile::write(std::span<const double> row) {
  file_.write(fmt::format("{}\n", fmt::join(row, ",")));
}

}  // namespace mbs
