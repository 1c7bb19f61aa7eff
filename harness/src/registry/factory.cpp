#include "registry/factory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "registry/setting_names.hpp"
#include "scene/row_names.hpp"

namespace mbs {
namespace {

bool is_scheme_served(const Serves& serves, Scheme scheme) {
  switch (scheme) {
    case Scheme::penalty:
      return true;
    case Scheme::saddle_point:
      return serves.saddle_point;
    case Scheme::rattle:
    case Scheme::rattle4:
    case Scheme::rattle6:
      return serves.rattle;
    case Scheme::multistep6:
      return serves.multistep;
  }
  return false;
}

bool is_precision_served(const Serves& serves, Precision precision) {
  switch (precision) {
    case Precision::double_precision:
      return true;
    case Precision::single_precision:
      return serves.single_precision;
    case Precision::mixed:
      return serves.mixed_precision;
  }
  return false;
}

/// Collects the terms of a model.
class Finder {
 public:
  template <class Items, class Is>
  void find(Term term, const char* kind, const Items& items, Is is) {
    const auto found = std::ranges::find_if(items, is);
    if (found != items.end()) add(term, fmt::format("{} '{}'", kind, found->name));
  }
  template <class Items>
  void find(Term term, const char* kind, const Items& items) {
    find(term, kind, items, [](const auto& /*one*/) { return true; });
  }
  void add(Term term, std::string where) {
    const bool known =
        std::ranges::any_of(found_, [&](const auto& one) { return one.first == term; });
    if (!known) found_.emplace_back(term, std::move(where));
  }
  std::vector<std::pair<Term, std::string>> found() && { return std::move(found_); }

 private:
  std::vector<std::pair<Term, std::string>> found_;
};

std::string constraint_name(const Model& model, int index) {
  const auto i = static_cast<std::size_t>(index);
  const std::size_t dots = model.dot_constraints().size();
  const std::size_t both = dots + model.bilinear_constraints().size();
  return i < dots   ? model.dot_constraints()[i].name
         : i < both ? model.bilinear_constraints()[i - dots].name
                    : model.linear_constraints()[i - both].name;
}

/// Laws over a rate are dampers too, and those with a factor of time drivers.
void find_laws(const Model& model, Finder& finder) {
  const auto find = [&finder](const char* kind, const auto& laws) {
    finder.find(Term::force_laws, kind, laws);
    finder.find(Term::dampers, kind, laws,
                [](const auto& one) { return !one.law.by_rate.is_zero(); });
    finder.find(Term::drivers, kind, laws,
                [](const auto& one) { return !one.law.factor.is_constant(); });
  };
  find("force law", model.force_laws());
  find("torque law", model.torque_laws());
}

void find_drivers(const Model& model, Finder& finder) {
  if (!model.driven_points().empty()) {
    const auto point = static_cast<std::size_t>(model.driven_points()[0].point);
    finder.add(Term::drivers, fmt::format("driven point '{}'", model.points()[point].name));
  }
  if (!model.driven_values().empty()) {
    finder.add(Term::drivers,
               fmt::format("driven constraint '{}'",
                           constraint_name(model, model.driven_values()[0].constraint)));
  }
}

void find_mass_across_axes(const Model& model, Finder& finder) {
  // Free points tile q with as many coordinates each as there are axes.
  const auto axis = [&](int coordinate) { return coordinate % model.dimension(); };
  const auto mass = model.mass();
  const auto found = std::ranges::find_if(mass, [&](const MassEntry& one) {
    return one.value != 0.0 && axis(one.row) != axis(one.col);
  });
  if (found == mass.end()) return;
  finder.add(Term::mass_across_axes,
             fmt::format("between '{}' and '{}'", variable_name(model, found->row),
                         variable_name(model, found->col)));
}

const std::string& name_of(Term term) {
  const auto is_same = [term](const auto& one) { return one.second == term; };
  return std::ranges::find_if(term_names(), is_same)->first;
}

void require_served(const Variant& variant, const Model& model, const StepSettings& settings) {
  const std::string unsuited = why_unsuited(model, settings);
  if (!unsuited.empty()) throw Unsupported(unsuited);
  const auto refuse = [](const char* verb, const std::string& missing) {
    if (missing.empty()) return;
    throw Unsupported(fmt::format("it does not {} {} (mbs list tells who does)", verb, missing));
  };
  refuse("offer", why_not_served(variant.serves, settings));
  refuse("serve", why_not_served(variant.serves.terms, model));
}

}  // namespace

const std::vector<std::pair<std::string, Term>>& term_names() {
  static const std::vector<std::pair<std::string, Term>> names{
      {"dots", Term::dots},
      {"bilinear constraints", Term::bilinear},
      {"linear constraints", Term::linear},
      {"springs", Term::springs},
      {"torsion springs", Term::torsion_springs},
      {"dampers", Term::dampers},
      {"couples", Term::couples},
      {"force laws", Term::force_laws},
      {"drivers", Term::drivers},
      {"mass across axes", Term::mass_across_axes},
      {"three dimensions", Term::spatial}};
  return names;
}

Terms all_terms() {
  Terms all;
  for (const auto& [name, term] : term_names()) all = all.with(term);
  return all;
}

std::vector<std::pair<Term, std::string>> terms_of(const Model& model) {
  Finder finder;
  if (model.dimension() == 3) finder.add(Term::spatial, "dimension 3");
  finder.find(Term::dots, "constraint", model.dot_constraints(),
              [](const auto& one) { return !one.is_distance(); });
  finder.find(Term::bilinear, "constraint", model.bilinear_constraints());
  finder.find(Term::linear, "constraint", model.linear_constraints());
  const auto damped = [](const auto& one) { return one.damping != 0.0; };
  finder.find(Term::springs, "spring", model.springs());
  finder.find(Term::torsion_springs, "torsion spring", model.torsion_springs());
  finder.find(Term::dampers, "spring", model.springs(), damped);
  finder.find(Term::dampers, "torsion spring", model.torsion_springs(), damped);
  finder.find(Term::couples, "couple", model.couples());
  find_laws(model, finder);
  find_drivers(model, finder);
  find_mass_across_axes(model, finder);
  return std::move(finder).found();
}

std::string why_not_served(const Terms& terms, const Model& model) {
  for (const auto& [term, where] : terms_of(model)) {
    if (terms.has(term)) continue;
    return fmt::format("{}: the scene has {}", name_of(term), where);
  }
  return "";
}

std::string why_not_served(const Serves& serves, const StepSettings& s) {
  if (!is_scheme_served(serves, s.scheme)) return "--scheme " + name_of(s.scheme);
  if (s.multipliers != MultiplierUpdate::every_pass && !serves.multiplier_update) {
    return "--multipliers " + name_of(s.multipliers);
  }
  if (s.tangent != TangentReuse::none && !serves.tangent_reuse) {
    return "--tangent " + name_of(s.tangent);
  }
  if (s.projections_every != 1 && !serves.projections_every) return "--projections-every";
  if (s.geometric_stiffness && !serves.geometric_stiffness) return "--geometric-stiffness";
  return is_precision_served(serves, s.precision) ? "" : "--precision " + name_of(s.precision);
}

std::string why_not_served(const Serves& serves, const Model& model, const StepSettings& settings) {
  const std::string setting = why_not_served(serves, settings);
  return setting.empty() ? why_not_served(serves.terms, model) : setting;
}

std::string why_unsuited(const Model& model, const StepSettings& settings) {
  if (!is_explicit(settings.scheme)) return "";
  const auto used = terms_of(model);
  for (const Term term : {Term::drivers, Term::dampers}) {
    if (std::ranges::any_of(used, [term](const auto& one) { return one.first == term; })) {
      return fmt::format("--scheme {} is for scenes without {}", name_of(settings.scheme),
                         name_of(term));
    }
  }
  return "";
}

namespace {

/// With a factor of 0 nothing would hold the constraints.
void require_chosen(const StepSettings& settings) {
  if (settings.penalty > 0.0 && settings.tolerance > 0.0) return;
  throw std::invalid_argument("penalty and tolerance are not chosen: chosen() of run/settings.hpp");
}

}  // namespace

std::unique_ptr<Simulation> create_simulation(const Variant& variant, const Model& model,
                                              const StepSettings& settings) {
  require_served(variant, model, settings);
  require_chosen(settings);
  return variant.create(model, settings);
}

std::unique_ptr<BatchSimulation> create_batch(const Variant& variant,
                                              std::span<const Model* const> models,
                                              std::span<const StepSettings> settings) {
  if (variant.create_batch == nullptr) return nullptr;
  for (std::size_t i = 0; i < models.size(); ++i) require_served(variant, *models[i], settings[i]);
  std::ranges::for_each(settings, require_chosen);
  return variant.create_batch(models, settings);
}

std::unique_ptr<Operations> create_operations(const Variant& variant, const Model& model) {
  if (variant.operations == nullptr) return nullptr;
  require_served(variant, model, {});
  return variant.operations(model);
}

std::vector<std::string> served_settings(const Serves& serves) {
  std::vector<std::string> result;
  const auto add = [&result](bool served, const char* name) {
    if (served) result.emplace_back(name);
  };
  add(serves.saddle_point, "saddle-point");
  add(serves.rattle, "rattle");
  add(serves.multistep, "multistep");
  add(serves.multiplier_update, "multipliers");
  add(serves.tangent_reuse, "tangent");
  add(serves.projections_every, "projections-every");
  add(serves.single_precision, "single");
  add(serves.mixed_precision, "mixed");
  add(serves.geometric_stiffness, "geometric-stiffness");
  return result;
}

std::vector<std::string> served_terms(const Terms& terms) {
  std::vector<std::string> result;
  for (const auto& [name, term] : term_names()) {
    if (terms.has(term)) result.push_back(name);
  }
  return result;
}

}  // namespace mbs
