// What makes a driver smooth is checked here; time_functions.cpp trusts it.
#include "scene_file/kinds/drivers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "scene/time_functions.hpp"

namespace mbs {
namespace {

/// A function and the longest step (s) that resolves it, infinite unless that is limited.
struct GivenFunction {
  TimeFunction value;
  double longest_step = std::numeric_limits<double>::infinity();
  std::string resolution = {};  ///< what longest_step is, for messages
};

constexpr std::size_t kMostCoefficients = 32;
constexpr std::size_t kFewestRows = 4;

TimeFunction read_polynomial(const JsonNode& node) {
  std::vector<double> coefficients = node.numbers();
  if (coefficients.empty() || coefficients.size() > kMostCoefficients) {
    node.fail(fmt::format("an array of 1 to {} numbers", kMostCoefficients));
  }
  while (coefficients.size() > 1 && coefficients.back() == 0.0) coefficients.pop_back();
  if (coefficients.size() == 1) return coefficients.front();
  return polynomial(std::move(coefficients));
}

GivenFunction read_sine(const JsonNode& node) {
  node.allow_keys({"amplitude", "frequency", "phase", "offset"});
  Sine values{node.get("amplitude").number(),
              node.get("frequency").number_at_least(0.0, "a frequency in Hz of at least 0")};
  if (const auto phase = node.find("phase")) values.phase = phase->number();
  if (const auto offset = node.find("offset")) values.offset = offset->number();
  if (values.amplitude == 0.0 || values.frequency == 0.0) return {sine(values)};
  return {sine(values), 1.0 / (kStepsPerPeriod * values.frequency),
          fmt::format("1/{:g} of the sine's period", kStepsPerPeriod)};
}

GivenFunction read_table(const JsonNode& node) {
  node.allow_keys({"times", "values"});
  const JsonNode times_node = node.get("times"), values_node = node.get("values");
  std::vector<double> times = times_node.numbers(), values = values_node.numbers();
  if (times.size() < kFewestRows) {
    times_node.fail(fmt::format("at least {} times: fewer make no smooth function", kFewestRows));
  }
  if (values.size() != times.size()) {
    values_node.fail(fmt::format("as many values as times, {}", times.size()));
  }
  const auto items = times_node.items();
  if (times.front() > 0.0) items.front().fail("a first time of at most 0, when the run starts");
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) continue;
    items[i].fail(fmt::format("a time above the one before, {}", times[i - 1]));
  }
  if (const auto row = corner_of(times, values)) {
    values_node.items()[*row].fail(
        fmt::format("a corner at t = {} s", times[*row]),
        "a smooth function, whose slope changes over at least four rows (a corner would need an "
        "infinite force)");
  }
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < times.size(); ++i) {
    shortest = std::min(shortest, times[i] - times[i - 1]);
  }
  return {spline(std::move(times), std::move(values)), shortest,
          "the table's shortest row distance"};
}

/// Inputs of one name are one input.
TimeFunction read_input(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "value"});
  const JsonNode name = node.get("name");
  if (!is_usable_name(name.text())) name.fail(kUsableName);
  const auto value = node.find("value");
  const double start = value ? value->number() : 0.0;
  std::vector<Input>& inputs = reader.draft().inputs;
  auto found = std::ranges::find(inputs, name.text(), &Input::name);
  if (found == inputs.end()) {
    found = inputs.insert(
        found,
        {name.text(), start, std::make_shared<TimeFunction::Sample>(TimeFunction::Sample{start})});
  } else if (found->start != start) {
    node.fail(fmt::format("an input that starts at {:g}", start),
              fmt::format("{:g}, where the input of this name starts elsewhere", found->start));
  }
  return input(found->now);
}

GivenFunction read_function(SceneReader& reader, const JsonNode& node, const std::string& unit) {
  if (node.is_number()) return {node.number()};
  if (!node.is_object()) {
    node.fail("a number " + unit + ", or an object with polynomial, sine, table or input");
  }
  node.allow_keys({"polynomial", "sine", "table", "input"});
  const auto members = node.members();
  if (members.size() != 1) {
    node.fail(fmt::format("an object with {} members", members.size()),
              "one of polynomial, sine, table, input");
  }
  const auto& [kind, value] = members.front();
  if (kind == "polynomial") return {read_polynomial(value)};
  if (kind == "input") return {read_input(reader, value)};
  return kind == "sine" ? read_sine(value) : read_table(value);
}

}  // namespace

TimeFunction read_driver(SceneReader& reader, const JsonNode& node, const std::string& unit,
                         Driver driver) {
  const GivenFunction given = read_function(reader, node, unit);
  if (given.value.is_constant()) return given.value;
  driver.path = node.path();
  driver.value = given.value;
  driver.longest_step = given.longest_step;
  driver.resolution = given.resolution;
  reader.draft().drivers.push_back(std::move(driver));
  return given.value;
}

void read_value(SceneReader& reader, DraftConstraint& constraint, const std::string& unit,
                Driver driver) {
  const auto value = constraint.node.find("value");
  if (!value) return;
  driver.name = constraint.name;
  constraint.value = read_driver(reader, *value, unit, std::move(driver));
}

}  // namespace mbs
