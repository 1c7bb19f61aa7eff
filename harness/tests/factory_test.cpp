// What a variant does not serve is refused by name, before anything of it is called.
#include "registry/factory.hpp"

#include <gtest/gtest.h>

#include "bench/null_variant.hpp"
#include "scene_file/load_scene.hpp"
#include "support/term_models.hpp"

namespace mbs {
namespace {

Terms only(const std::vector<std::pair<Term, std::string>>& used, Term except) {
  Terms found;
  for (const auto& [term, where] : used) {
    if (term != except) found = found.with(term);
  }
  return found;
}

std::string name_of(Term term) {
  for (const auto& [name, one] : term_names()) {
    if (one == term) return name;
  }
  return "";
}

const Model& model_of(const std::string& name) {
  static const std::vector<TermModel> models = term_models();
  for (const TermModel& one : models) {
    if (one.name == name) return one.model;
  }
  throw std::invalid_argument(name);
}

TEST(Factory, EveryTermOfAModelHasToBeServed) {
  std::size_t most = 0;
  for (const TermModel& one : term_models()) {
    SCOPED_TRACE(one.name);
    const auto used = terms_of(one.model);
    most = std::max(most, used.size());
    EXPECT_EQ(why_not_served(all_terms(), one.model), "");
    for (const auto& [term, where] : used) {
      EXPECT_EQ(why_not_served(only(used, term), one.model),
                name_of(term) + ": the scene has " + where);
    }
  }
  EXPECT_EQ(most, term_names().size());  // "everything, spatial" has them all
}

TEST(Factory, ThePapersMechanismAtAnyFillNeedsTheDefaultAlone) {
  for (const char* name : {"four-bar:1", "four-bar:10", "four-bar:10,fill=1"}) {
    EXPECT_TRUE(terms_of(load_scene(name).model).empty()) << name;
  }
}

TEST(Factory, TermsAreNamedWithTheItemThatHasThem) {
  const auto why = [](const char* name) { return why_not_served(Terms{}, model_of(name)); };
  EXPECT_EQ(why("chain, planar"), "");
  EXPECT_EQ(why("chain, spatial"), "three dimensions: the scene has dimension 3");
  EXPECT_NE(why("springs, planar").find("springs: the scene has spring '"), std::string::npos);
  EXPECT_NE(why("bilinear, planar").find("bilinear constraints: the scene has constraint '"), std::string::npos);
  EXPECT_EQ(why("driven rod, planar"), "drivers: the scene has driven point 'P'");
}

std::unique_ptr<Simulation> never(const Model& /*model*/, const StepSettings& /*settings*/) {
  ADD_FAILURE() << "was called";
  return nullptr;
}

std::unique_ptr<BatchSimulation> never_a_batch(std::span<const Model* const> /*models*/,
                                               std::span<const StepSettings> /*settings*/) {
  ADD_FAILURE() << "was called";
  return nullptr;
}

std::unique_ptr<Operations> never_operations(const Model& /*model*/) {
  ADD_FAILURE() << "was called";
  return nullptr;
}

TEST(Factory, RefusesAllThatItMakesBeforeAnythingRuns) {
  const Model& springs = model_of("springs, planar");
  const Variant variant{.name = "plain",
                        .description = "",
                        .create = never,
                        .operations = never_operations,
                        .create_batch = never_a_batch};
  const std::vector<const Model*> models{&model_of("chain, planar"), &springs};
  const std::vector<StepSettings> settings(2);
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const Unsupported& error) {
      return error.what();
    }
    return "";
  };
  const std::string alone = message([&] { create_simulation(variant, springs, {}); });
  EXPECT_TRUE(alone.starts_with("it does not serve springs: the scene has spring '")) << alone;
  EXPECT_EQ(message([&] { create_batch(variant, models, settings); }), alone);
  EXPECT_EQ(message([&] { create_operations(variant, springs); }), alone);
  EXPECT_EQ(message([&] { create_simulation(variant, *models[0], {.scheme = Scheme::rattle}); }),
            "it does not offer --scheme rattle (mbs list tells who does)");
}

TEST(Factory, OffersNoBatchAndNoOperationsWhereThereAreNone) {
  EXPECT_EQ(create_batch(null_variant(), {}, {}), nullptr);
  EXPECT_EQ(create_operations(null_variant(), model_of("chain, planar")), nullptr);
}

TEST(Factory, WhatAVariantDoesNotServeIsSaid) {
  const Serves nothing, everything{all_terms(), true, true, true, true, true, true, true, true, true};
  for (const auto& [settings, option] : std::vector<std::pair<StepSettings, std::string>>{
           {{.scheme = Scheme::saddle_point}, "--scheme saddle-point"},
           {{.scheme = Scheme::rattle4}, "--scheme rattle4"},
           {{.multipliers = MultiplierUpdate::converged}, "--multipliers converged"},
           {{.tangent = TangentReuse::step}, "--tangent every-step"},
           {{.projections_every = 2}, "--projections-every"},
           {{.precision = Precision::single_precision}, "--precision single"},
           {{.geometric_stiffness = true}, "--geometric-stiffness"},
           {{.precision = Precision::mixed}, "--precision mixed"}}) {
    EXPECT_EQ(why_not_served(nothing, settings), option);
    EXPECT_EQ(why_not_served(everything, settings), "") << option;
  }
  EXPECT_EQ(why_not_served(nothing, {}), "");
  const Model& springs = model_of("springs, planar");
  EXPECT_EQ(why_not_served(nothing, springs, {.precision = Precision::mixed}), "--precision mixed");
  EXPECT_EQ(why_not_served(nothing, springs, {}), why_not_served(Terms{}, springs));
  EXPECT_EQ(why_not_served(everything, springs, {.precision = Precision::mixed}), "");
}

TEST(Factory, RattleIsForScenesWithoutDriversAndDampers) {
  int suited = 0, unsuited = 0;
  for (const TermModel& term : term_models()) {
    EXPECT_EQ(why_unsuited(term.model, {}), "");
    (why_unsuited(term.model, {.scheme = Scheme::rattle}).empty() ? suited : unsuited) += 1;
  }
  EXPECT_GT(suited, 0);
  EXPECT_GT(unsuited, 0);
}

}  // namespace
}  // namespace mbs
