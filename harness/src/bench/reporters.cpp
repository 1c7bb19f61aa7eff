// Adapts Google Benchmark's reporters.
#include "bench/reporters.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <utility>

namespace mbs {
namespace {

using Runs = std::vector<benchmark::BenchmarkReporter::Run>;

Runs as_registered(Runs runs) {
  for (auto& run : runs) run.run_name.time_type.clear();
  return runs;
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::string without_non_finite(const std::string& json) {
  // A string ends its line with a quotation mark, so that none can be mistaken for a number.
  std::istringstream stream(json);
  std::string result;
  for (std::string line; std::getline(stream, line);) {
    const std::string_view comma = line.ends_with(',') ? "," : "";
    const std::string_view rest = std::string_view(line).substr(0, line.size() - comma.size());
    for (const std::string_view value : {": NaN", ": -NaN", ": Infinity", ": -Infinity"}) {
      if (!rest.ends_with(value)) continue;
      line = fmt::format("{}: null{}", rest.substr(0, rest.size() - value.size()), comma);
      break;
    }
    result += line;
    if (!stream.eof()) result += '\n';
  }
  return result;
}

std::string without_host(const std::string& opening) {
  auto document = nlohmann::ordered_json::parse(opening + "]}");
  auto& context = document.at("context");
  context.erase("host_name");
  const std::string executable = context.value("executable", "");
  context["executable"] = std::filesystem::path(executable).filename().string();
  const std::string text = document.dump(2);
  return text.substr(0, text.rfind(']')) + "\n";
}

bool JsonReporter::ReportContext(const Context& context) {
  std::ostream& out = GetOutputStream();
  std::ostringstream text;
  SetOutputStream(&text);
  const bool go_on = JSONReporter::ReportContext(context);
  SetOutputStream(&out);
  out << without_host(text.str());
  return go_on;
}

void JsonReporter::ReportRuns(const std::vector<Run>& runs) {
  std::ostream& out = GetOutputStream();
  std::ostringstream text;
  SetOutputStream(&text);
  JSONReporter::ReportRuns(as_registered(runs));
  SetOutputStream(&out);
  out << without_non_finite(text.str()) << std::flush;
}

void JsonReporter::Finalize() {
  JSONReporter::Finalize();
  complete_ = GetOutputStream().flush().good();
}

void DisplayReporter::ReportRuns(const std::vector<Run>& runs) {
  Runs shown = as_registered(runs);
  // The CSV reporter aborts unless all runs have the same counters.
  const bool all_alike = dynamic_cast<benchmark::CSVReporter*>(inner_.get()) != nullptr;
  for (auto& run : shown) {
    const benchmark::UserCounters all = std::exchange(run.counters, {});
    for (const std::string& name : shown_) {
      const auto found = all.find(name);
      const auto counter = found != all.end() ? found->second : benchmark::Counter(kNone);
      if (all_alike || std::isfinite(counter.value)) run.counters[name] = counter;
    }
  }
  inner_->ReportRuns(shown);
}

std::unique_ptr<benchmark::BenchmarkReporter> make_display_reporter(
    std::span<const char* const> shown) {
  std::unique_ptr<benchmark::BenchmarkReporter> chosen(benchmark::CreateDefaultDisplayReporter());
  if (dynamic_cast<benchmark::JSONReporter*>(chosen.get()) != nullptr) {
    return std::make_unique<JsonReporter>();
  }
  return std::make_unique<DisplayReporter>(std::move(chosen), shown);
}

}  // namespace mbs
