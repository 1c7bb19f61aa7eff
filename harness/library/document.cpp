// Scenes as documents, and which implementation to take for one.
#include <fmt/format.h>

#include "describe/describe.hpp"
#include "describe/features.hpp"
#include "describe/recommendation.hpp"
#include "environment/build_info.hpp"
#include "library/content.hpp"
#include "run/settings.hpp"
#include "scene_file/json_text.hpp"
#include "scene_file/load_scene.hpp"
#include "sweep/scene_number.hpp"

namespace mbs {
namespace {

using nlohmann::json;

/// What `mbs describe --json` prints; with `scheme`, of this form whatever suits the scene.
json description_of(const Scene& scene, const StepSettings& settings,
                    const char* scheme = nullptr) {
  if (!(settings.step >= 1e-12 && settings.step <= 1e6)) {
    throw UsageError(fmt::format("the step is {:g} s: it must be 1e-12 to 1e6 s", settings.step));
  }
  json description = describe_json(scene, settings);
  if (scheme != nullptr) {
    description["scheme"]["take"] = scheme;
    description["features"] = features_json(description);
  }
  description.update(recommendation_json(parse_rule(kRuleText), description,
                                         [&](const std::string& variant, Scheme asked) {
                                           StepSettings with = settings;
                                           with.scheme = asked;
                                           return why_not_offered(variant, scene.model, with);
                                         }));
  return description;
}

/// The fastest that the rule expects.
Choice choose_by_rule(const Scene& scene, StepSettings settings) {
  if (is_explicit(settings.scheme)) {
    throw UsageError(fmt::format("--scheme {} is not in the measured rule: name an implementation",
                                 name_of(settings.scheme)));
  }
  const bool is_saddle = settings.scheme == Scheme::saddle_point;
  const bool may_choose = settings.penalty == 0.0 && settings.multipliers == MultiplierUpdate::every_pass;
  const char* asked = is_saddle ? "saddle-point" : may_choose ? nullptr : "penalty";
  const json found = description_of(scene, settings, asked);
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
                      is_own ? "none" : folder.library, is_own ? "" : folder.licence});
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
    return SceneDocument(std::make_unique<Content>(Content{scene, load_document(scene)}));
  });
}

SceneDocument SceneDocument::parse(std::string_view json, const std::string& name) {
  return refusing([&] {
    return SceneDocument(std::make_unique<Content>(Content{name, parse_json(json, name)}));
  });
}

double SceneDocument::number(const std::string& path) const {
  return refusing([&] {
    const nlohmann::json& value = content_->document[find_number(content_->document, path)];
    if (value.is_number()) return value.get<double>();
    throw Refused(fmt::format(
        "{}: found the expression {}, allowed is a number: ask for the parameters that it names, or "
        "set one",
        path, value.dump()));
  });
}

void SceneDocument::set_number(const std::string& path, double value) {
  refusing([&] { return content_->document[find_number(content_->document, path)] = value; });
}

const std::string& SceneDocument::name() const { return content_->name; }
std::string SceneDocument::json() const { return content_->document.dump(2); }

std::string SceneDocument::describe(double step) const {
  return refusing([&] {
    StepSettings settings;
    settings.step = step;
    return description_of(scene_of(content_->document, content_->name), settings).dump(2);
  });
}

}  // namespace mbs
