// Tables as CSV, which appear whole or not at all; compressed where the name ends in ".gz".
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mbs/table_file.hpp"

namespace mbs {

/// With its end.
std::string csv_line(std::span<const std::string> row);

/// One line of column names, then rows of numbers that round-trip, or of text. Names and text with
/// a comma, a quote or a line break are quoted as RFC 4180 says.
class CsvFile {
 public:
  /// Throws UsageError if `path` cannot be written.
  CsvFile(const std::string& path, const std::vector<std::string>& columns);
  void write(std::span<const double> row);
  void write(std::span<const std::string> row);
  /// Makes the file appear under its name. Throws UsageError if not everything could be written.
  void commit() { file_.commit(); }

 private:
  TableFile file_;
};

}  // namespace mbs
