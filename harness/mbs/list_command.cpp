// mbs list: what this build offers, and what it lacks and why.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "environment/blas.hpp"
#include "limit/limit.hpp"
#include "mbs/commands.hpp"
#include "registry/registry.hpp"
#include "run/setting_names.hpp"

namespace mbs {
namespace {

nlohmann::json blas_json() {
  nlohmann::json pairs = nlohmann::json::array();
  for (const BlasPair& pair : blas_pairs()) {
    const std::string reason = why_unavailable(pair);
    pairs.push_back({{"name", pair.name},
                     {"blas", pair.blas},
                     {"lapack", pair.lapack},
                     {"available", reason.empty()},
                     {"reason", reason}});
  }
  return pairs;
}

nlohmann::json list_json() {
  nlohmann::json implementations = nlohmann::json::array();
  for (const RegistryEntry& entry : registry()) {
    const Implementation& implementation = entry.implementation;
    nlohmann::json variants = nlohmann::json::array();
    for (const Variant& variant : implementation.variants) {
      variants.push_back({{"name", entry.folder + "/" + variant.name},
                          {"description", variant.description},
                          {"dense", variant.dense},
                          {"unsymmetric", variant.unsymmetric},
                          {"operations", variant.operations != nullptr},
                          {"settings", served_settings(variant.serves)}});
    }
    implementations.push_back({{"folder", entry.folder},
                               {"description", implementation.description},
                               {"library", implementation.library},
                               {"version", implementation.version},
                               {"licence", implementation.licence},
                               {"available", entry.unavailable.empty()},
                               {"reason", entry.unavailable},
                               {"variants", variants}});
  }
  return {
      {"implementations", implementations},
      {"reference_line", {{"name", limit::kName}, {"description", limit::variant().description}}},
      {"blas", blas_json()}};
}

void print_list() {
  for (const RegistryEntry& entry : registry()) {
    if (!entry.unavailable.empty()) {
      fmt::print("{:<24} unavailable: {}\n", entry.folder + "/*", entry.unavailable);
      continue;
    }
    const Implementation& implementation = entry.implementation;
    for (const Variant& variant : implementation.variants) {
      const std::string library = implementation.library == "none"
                                      ? "no library"
                                      : fmt::format("{} {}, {}", implementation.library,
                                                    implementation.version, implementation.licence);
      fmt::print("{:<24} {}; {} ({})\n", entry.folder + "/" + variant.name,
                 implementation.description, variant.description, library);
      const std::vector<std::string> served = served_settings(variant.serves);
      if (!served.empty()) fmt::print("{:<24} also {}\n", "", fmt::join(served, ", "));
    }
  }
  fmt::print("\nReference line, only if named:\n{:<24} {}\n", limit::kName,
             limit::variant().description);
  fmt::print("\nBLAS and LAPACK (--blas NAME):\n");
  for (const BlasPair& pair : blas_pairs()) {
    const std::string reason = why_unavailable(pair);
    fmt::print("{:<24} {} with {}{}{}\n", pair.name, pair.blas, pair.lapack,
               reason.empty() ? "" : "; unavailable: ", reason);
  }
}

}  // namespace

void add_list_command(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("list", "list the implementations and their libraries");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "machine-readable");
  command->callback([json, &status] {
    if (*json) {
      fmt::print("{}\n", list_json().dump(2));
    } else {
      print_list();
    }
    status = 0;
  });
}

}  // namespace mbs
