// A step allocates nothing after warm-up, in every implementation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <new>

#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "run/settings.hpp"
#include "run/stretch.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "support/allocation_counter.hpp"
#include "support/gtest_name.hpp"

extern "C" void* malloc_in_library(std::size_t bytes);
extern "C" void* new_in_library(std::size_t bytes);

namespace mbs {
namespace {

using test::allocations;

constexpr const char* kNotCounted = "sanitizers bring their own malloc: nothing can be counted";

/// The compiler must not see what happens to the memory, or it may leave the allocation out.
template <class Allocate>
long counted(Allocate allocate) {
  const long before = allocations();
  void* volatile memory = allocate();
  const long after = allocations();
  EXPECT_NE(memory, nullptr);
  std::free(memory);
  return after - before;
}

TEST(AllocationCounter, CountsEveryWayToAllocate) {
  if (!test::counts_allocations()) GTEST_SKIP() << kNotCounted;
  EXPECT_EQ(counted([] { return std::malloc(40); }), 1);
  EXPECT_EQ(counted([] { return std::calloc(5, 8); }), 1);
  EXPECT_EQ(counted([] { return std::realloc(nullptr, 40); }), 1);
  EXPECT_EQ(counted([] { return std::aligned_alloc(64, 128); }), 1);
  EXPECT_EQ(counted([] {
              void* memory = nullptr;
              return posix_memalign(&memory, 64, 128) == 0 ? memory : nullptr;
            }),
            1);
  EXPECT_EQ(counted([] { return ::operator new(40); }), 1);
  EXPECT_EQ(counted([] { return ::operator new (40, std::align_val_t{64}); }), 1);
}

TEST(AllocationCounter, CountsInSharedLibraries) {
  if (!test::counts_allocations()) GTEST_SKIP() << kNotCounted;
  EXPECT_EQ(counted([] { return malloc_in_library(40); }), 1);
  EXPECT_EQ(counted([] { return new_in_library(40); }), 1);
}

TEST(AllocationCounter, CountsNothingWhereNothingHappens) {
  if (!test::counts_allocations()) GTEST_SKIP() << kNotCounted;
  const long before = allocations();
  EXPECT_EQ(allocations() - before, 0);
}

/// Planar free fall: no constraint at all.
Scene free_fall() {
  ModelData data;
  data.points = {{"P", 0, {1.0, 2.0, 0.0}}, {"R", 2, {3.0, 4.0, 0.0}}};
  for (int i = 0; i < 4; ++i) data.mass.push_back({i, i, 2.0});
  data.force = {0.0, -19.62, 0.0, -19.62};
  data.initial_velocity = {1.0, 0.0, 0.0, 1.0};
  return {"free fall", Model(std::move(data)), {}, {}};
}

/// Spatial: a rod that hangs from the ground, a point kept at right angles to it, and a slider.
Scene spatial() {
  ModelData data;
  data.dimension = 3;
  data.points = {{"A", -1, {0.0, 0.0, 0.0}},
                 {"B", 0, {1.0, 0.0, 0.0}},
                 {"C", 3, {1.0, 1.0, 0.0}},
                 {"D", 6, {0.0, 0.0, 2.0}}};
  data.dot_constraints = {
      {1, 0, 1, 0, 1.0, "AB"}, {2, 1, 2, 1, 1.0, "BC"}, {1, 0, 2, 1, 0.0, "right angle"}};
  data.linear_constraints = {{{{6, 1.0}, {7, 0.5}}, 0.0, "slider"}};
  for (int i = 0; i < 9; ++i) data.mass.push_back({i, i, 1.0});
  data.mass.push_back({3, 0, 0.2});
  data.force = {0.0, 0.0, -9.81, 0.0, 0.0, -9.81, 0.0, 0.0, -9.81};
  data.initial_velocity.assign(9, 0.0);
  return {"spatial", Model(std::move(data)), {}, {}};
}

/// What all variants step; to find a stretch takes longer than to step it.
struct Prepared {
  Scene scene;
  StepSettings settings;
  Stretch stretch;
};

constexpr int kStretchSteps = 120;

/// The stretch passes a singular position of the four-bar in its middle, where passes, multipliers
/// and pivots change most.
Prepared prepare(Scene scene) {
  const StepSettings settings = chosen(scene.model);
  Stretch stretch = make_stretch(scene, settings.step, kStretchSteps);
  return {std::move(scene), settings, std::move(stretch)};
}

const std::vector<Prepared>& prepared() {
  static const std::vector<Prepared> all = [] {
    std::vector<Prepared> result;
    for (const char* name : {"four-bar:1", "four-bar:10", "four-bar:40", "four-bar:10,fill=0.6",
                             "four-bar:80", "four-bar:80,fill=1"}) {
      result.push_back(prepare(load_scene(name)));
    }
    result.push_back(prepare(free_fall()));
    result.push_back(prepare(spatial()));
    return result;
  }();
  return all;
}

/// Allocations of the steps after five of warm-up.
long allocations_of_steps(const Variant& variant, const Prepared& one) {
  constexpr int kWarmUp = 5;
  const auto simulation = create_simulation(variant, one.scene.model, one.settings);
  simulation->set_state(one.stretch.initial);
  for (int i = 0; i < kWarmUp; ++i) {
    EXPECT_NE(simulation->step().status, StepStatus::factorization_failed);
  }
  int failed = 0;
  const long before = allocations();
  for (int i = kWarmUp; i < kStretchSteps; ++i) {
    if (simulation->step().status == StepStatus::factorization_failed) ++failed;
  }
  const long after = allocations();
  EXPECT_EQ(failed, 0);
  return after - before;
}

class AllocationFreeStep : public ::testing::TestWithParam<NamedVariant> {};

/// Zero on every scene, unless the variant says that its library allocates: then it must be true.
TEST_P(AllocationFreeStep, OnEveryScene) {
  if (!test::counts_allocations()) GTEST_SKIP() << kNotCounted;
  long most = 0;
  for (const Prepared& one : prepared()) {
    SCOPED_TRACE(one.scene.name);
    try {
      const long count = allocations_of_steps(*GetParam().variant, one);
      if (GetParam().variant->allocates.empty()) {
        EXPECT_EQ(count, 0) << "steps allocate: make storage in the constructor, or say in "
                               "Variant::allocates why the library leaves no choice";
      }
      most = std::max(most, count);
    } catch (const Unsupported&) {
      continue;  // `mbs check` is where this is reported
    }
  }
  if (!GetParam().variant->allocates.empty()) {
    EXPECT_GT(most, 0);
  }
}

std::string test_name(const ::testing::TestParamInfo<NamedVariant>& info) {
  return test::gtest_name(info.param.name);
}

INSTANTIATE_TEST_SUITE_P(All, AllocationFreeStep, ::testing::ValuesIn(all_variants()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AllocationFreeStep);

/// The measurement itself would notice a step that allocates.
class Allocating final : public Simulation {
 public:
  explicit Allocating(const Model& model) : Simulation(model, StepSettings{}) {}

 protected:
  void do_set_state(const State&) override {}
  StepOutcome do_step() override {
    std::free(malloc_in_library(8));
    return {StepStatus::converged, 1};
  }
  void do_get_state(State&) const override {}
};

TEST(AllocationCounter, NoticesAStepThatAllocates) {
  if (!test::counts_allocations()) GTEST_SKIP() << kNotCounted;
  const Variant variant{"allocating", "",
                        [](const Model& model, const StepSettings&) -> std::unique_ptr<Simulation> {
                          return std::make_unique<Allocating>(model);
                        }};
  EXPECT_EQ(allocations_of_steps(variant, prepare(free_fall())), 115);
}

}  // namespace
}  // namespace mbs
