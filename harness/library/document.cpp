// Scenes as documents, and which implementation to take for one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "describe/describe.hpp"
#include "describe/features.hpp"
#include "describe/recommendation.hpp"
#include "environment/build_info.hpp"
#include "library/content.hpp"
#include "registry/factory.hpp"
#include "run/settings.hpp"
#include "scene_file/json_text.hpp"
#include "scene_file/load_scene.hpp"
#include "sweep/scene_number.hpp"

namespace mbs {
namespace {

using nlohmann::json;

json scene_object(json document, const std::string& name) {
  if (document.is_object()) return document;
  throw UsageError(
      fmt::format("{}: found {}, allowed is an object, a scene", name, document.type_name()));
}

/// The fastest that the rule expects.
Choice choose_by_rule(const Scene& scene, StepSettings settings) {
  if (is_explicit(settings.scheme)) {
    const std::string unsuited = why_unsuited(scene.model, settings);
    if (!unsuited.empty()) throw Unsupported(unsuited);  // naming one would not help
    throw UsageError(fmt::format("--scheme {} is not in the measured rule: name an implementation",
                                 name_of(settings.scheme)));
  }
  const bool is_saddle = settings.scheme == Scheme::saddle_point;
  const bool may_choose =
      settings.penalty == 0.0 && settings.multipliers == MultiplierUpdate::every_pass;
  const char* asked = is_saddle ? "saddle-point" : may_choose ? nullptr : "penalty";
  require_step(settings.step);
  json described = describe_json(scene, settings);
  if (asked != nullptr) {
    described["scheme"]["take"] = asked;
    described["features"] = features_json(described);
  }
  const json found = recommended(std::move(described), scene, settings, false);
  const json* fastest = nullptr;
  for (const json& one : found["recommendation"]) {
    if (fastest == nullptr || one["step_us"] < (*fastest)["step_us"]) fastest = &one;
  }
  if (fastest == nullptr) {
    throw UsageError(fmt::format("no implementation can be chosen ({}): name one",
                                 found["no_recommendation"].get<std::string>()));
  }
  if ((*fastest)["scheme"] == name_of(Scheme::saddle_point)) settings.scheme = Scheme::saddle_point;
  return {select_variants({(*fastest)["implementation"]}).front(), settings};
}

}  // namespace

std::string without_options(std::string text) {
  const auto replace = [&text](const std::string& option, const std::string& with) {
    for (auto at = text.find(option); at != std::string::npos; at = text.find(option))
      text.replace(at, option.size(), with);
  };
  const json names = settings_json({});
  for (auto name = names.rbegin(); name != names.rend(); ++name) {  // the longer before its prefix
    std::string option = "--" + name.key();
    std::ranges::replace(option, '_', '-');
    replace(option, name.key());
  }
  replace("--vary ", "");
  return text;
}

Choice choose(const Scene& scene, const StepperOptions& options) {
  if (options.implementation == "auto") return choose_by_rule(scene, options.settings);
  const std::vector<NamedVariant> found = select_variants({options.implementation});
  if (found.size() == 1) return {found.front(), options.settings};
  throw UsageError(fmt::format("implementation '{}' has {} variants: name one of them, as {}",
                               options.implementation, found.size(), found.front().name));
}

std::vector<Offer> implementations() {
  std::vector<Offer> offers;
  for (const NamedVariant& one : all_variants()) {
    const Implementation& folder = one.entry->implementation;
    const bool is_own = is_own_code(folder, *one.variant);
    offers.push_back({one.name, folder.description + "; " + one.variant->description,
                      is_own ? "none" : folder.library, is_own ? "" : folder.licence,
                      one.variant->allocates});
  }
  return offers;
}

const char* version() { return build_info().version; }

SceneDocument::SceneDocument(std::unique_ptr<Content> content) : content_(std::move(content)) {}
SceneDocument::SceneDocument(const SceneDocument& other)
    : content_(std::make_unique<Content>(*other.content_)) {}
SceneDocument& SceneDocument::operator=(const SceneDocument& other) {
  *content_ = *other.content_;
  return *this;
}
SceneDocument::~SceneDocument() = default;

SceneDocument SceneDocument::load(const std::string& scene) {
  return refusing([&] {
    return SceneDocument(
        std::make_unique<Content>(Content{scene, scene_object(load_document(scene), scene)}));
  });
}

SceneDocument SceneDocument::parse(std::string_view json, const std::string& name) {
  return refusing([&] {
    return SceneDocument(
        std::make_unique<Content>(Content{name, scene_object(parse_json(json, name), name)}));
  });
}

double SceneDocument::number(const std::string& path) const {
  return refusing([&] {
    const nlohmann::json& value = content_->document[find_number(content_->document, path)];
    if (value.is_number()) return value.get<double>();
    throw Refused(
        fmt::format("{}: found the expression {}, allowed is a number: ask for the parameters that "
                    "it names, or set one",
                    path, value.dump()));
  });
}

void SceneDocument::set_number(const std::string& path, double value) {
  if (!std::isfinite(value)) {
    throw Refused(fmt::format("{}: found {:g}, allowed is a finite number", path, value));
  }
  refusing([&] { return content_->document[find_number(content_->document, path)] = value; });
  content_->unused = Unused::allowed;
}

const std::string& SceneDocument::name() const { return content_->name; }
std::string SceneDocument::json() const { return content_->document.dump(2); }

std::string SceneDocument::describe(double step) const {
  return refusing([&] {
    StepSettings settings;
    settings.step = step;
    require_step(step);
    const Scene scene = content_->scene();
    return recommended(describe_json(scene, settings), scene, settings, true).dump(2);
  });
}

}  // namespace mbs
