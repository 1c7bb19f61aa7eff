// mbs list: what this build offers, and what it lacks and why.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/null_variant.hpp"
#include "environment/blas.hpp"
#include "limit/limit.hpp"
#include "mbs/commands.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "scene/families/families.hpp"
#include "scene/scene.hpp"

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

const char* role_name(Role role) {
  switch (role) {
    case Role::contender:
      return "contender";
    case Role::paper:
      return "paper";
    case Role::example:
      return "example";
  }
  return "";
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
                          {"settings", served_settings(variant.serves)},
                          {"terms", served_terms(variant.serves.terms)}});
      if (variant.own_code) variants.back()["library"] = "none";
      if (!variant.tried_for.empty()) {
        variants.back()["tried_for"] = entry.folder + "/" + variant.tried_for;
      }
    }
    nlohmann::json lacking = nlohmann::json::object();
    for (const auto& [variant, reason] : entry.lacking) lacking[entry.folder + "/" + variant] = reason;
    implementations.push_back({{"folder", entry.folder},
                               {"description", implementation.description},
                               {"library", implementation.library},
                               {"version", implementation.version},
                               {"licence", implementation.licence},
                               {"role", role_name(implementation.role)},
                               {"available", entry.unavailable.empty()},
                               {"reason", entry.unavailable},
                               {"variants", variants},
                               {"lacking", lacking}});
  }
  return {
      {"implementations", implementations},
      {"reference_line", {{"name", limit::kName}, {"description", limit::variant().description}}},
      {"blas", blas_json()}};
}

/// A row a term or setting, a column a variant.
void print_coverage() {
  const std::vector<NamedVariant> variants = all_variants();
  const auto print_row = [&](const std::string& what, const auto& is_served) {
    fmt::print("{:<24}", what);
    for (const NamedVariant& one : variants) fmt::print(" {:>2}", is_served(*one.variant) ? "x" : ".");
    fmt::print("\n");
  };
  const auto has = [](const std::vector<std::string>& served, const std::string& name) {
    return std::ranges::find(served, name) != served.end();
  };
  fmt::print("\nBeyond the paper's step on planar distances, constant masses and gravity\n{:<24}", "");
  for (std::size_t i = 1; i <= variants.size(); ++i) fmt::print(" {:>2}", i);
  fmt::print("\n");
  for (const auto& [name, term] : term_names()) {
    print_row(name, [term = term](const Variant& one) { return one.serves.terms.has(term); });
  }
  for (const std::string& name : served_settings(null_variant().serves)) {
    print_row(name, [&](const Variant& one) { return has(served_settings(one.serves), name); });
  }
  for (std::size_t i = 0; i < variants.size(); ++i) {
    fmt::print("{}{} {}", i % 3 == 0 ? "\n  " : ", ", i + 1, variants[i].name);
  }
  fmt::print("\n");
}

void print_list() {
  for (const RegistryEntry& entry : registry()) {
    if (!entry.unavailable.empty()) {
      fmt::print("{:<24} unavailable: {}\n", entry.folder + "/*", entry.unavailable);
      continue;
    }
    const Implementation& implementation = entry.implementation;
    for (const Variant& variant : implementation.variants) {
      if (!variant.tried_for.empty()) continue;
      const std::string library = is_own_code(implementation, variant)
                                      ? "no library"
                                      : fmt::format("{} {}, {}", implementation.library,
                                                    implementation.version, implementation.licence);
      fmt::print("{:<24} {}; {} ({})\n", entry.folder + "/" + variant.name,
                 implementation.description, variant.description, library);
    }
    for (const auto& [variant, reason] : entry.lacking) {
      fmt::print("{:<24} unavailable: {}\n", entry.folder + "/" + variant, reason);
    }
  }
  print_coverage();
  fmt::print("\nTried and not taken, only if named in full:\n");
  for (const NamedVariant& one : tried_variants()) {
    fmt::print("{:<32} for {}: {}\n", one.name, one.variant->tried_for, one.variant->description);
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

/// Each scene that a name stands for.
void print_scenes() {
  const auto print = [](const std::string& form, const std::string& title, const std::string& ranges) {
    fmt::print("{:<26} {}\n{:<26} {}\n", form, title, "", ranges);
  };
  print("four-bar:N[,fill=F]", "the N-loop four-bar mechanism, F of its tangent filled",
        fmt::format("N from 1 to {}; F above 0, up to 1, its own fill if left out", kMostLoops));
  for (const SceneFamily& family : scene_families()) {
    print(family.form(), family.title, family.ranges());
  }
  fmt::print("At most {} variables in a family. More: harness/src/scene/families/README.md\n",
             kMostFamilyVariables);
}

}  // namespace

void add_list_command(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("list", "list the implementations and their libraries");
  const auto json = std::make_shared<bool>(false);
  const auto scenes = std::make_shared<bool>(false);
  auto* machine_readable = command->add_flag("--json", *json, "machine-readable");
  command->add_flag("--scenes", *scenes, "the families of mechanisms that a SCENE may be of")
      ->excludes(machine_readable);
  command->callback([json, scenes, &status] {
    if (*scenes) {
      print_scenes();
    } else if (*json) {
      fmt::print("{}\n", list_json().dump(2));
    } else {
      print_list();
    }
    status = 0;
  });
}

}  // namespace mbs
