// mbs list: what this build offers, and what it lacks and why.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "mbs/commands.hpp"
#include "registry/registry.hpp"

namespace mbs {
namespace {

nlohmann::json list_json() {
  nlohmann::json implementations = nlohmann::json::array();
  for (const RegistryEntry& entry : registry()) {
    const Implementation& implementation = entry.implementation;
    nlohmann::json variants = nlohmann::json::array();
    for (const Variant& variant : implementation.variants) {
      variants.push_back(
          {{"name", entry.folder + "/" + variant.name}, {"description", variant.description}});
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
  return {{"implementations", implementations}};
}

void print_list() {
  for (const RegistryEntry& entry : registry()) {
    if (!entry.unavailable.empty()) {
      fmt::print("{:<24} unavailable: {}\n", entry.folder + "/*", entry.unavailable);
      continue;
    }
    const Implementation& implementation = entry.implementation;
    for (const Variant& variant : implementation.variants) {
      fmt::print("{:<24} {}; {} ({} {}, {})\n", entry.folder + "/" + variant.name,
                 implementation.description, variant.description, implementation.library,
                 implementation.version, implementation.licence);
    }
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
