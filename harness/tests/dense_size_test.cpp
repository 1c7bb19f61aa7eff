// What stores every position of a matrix refuses a scene for which there would not be the memory.
#include <gtest/gtest.h>

#include <string>

#include "registry/factory.hpp"
#include "registry/registry.hpp"

namespace mbs {
namespace {

/// Planar points in free fall.
Model falling_points(int count) {
  ModelData data;
  for (int k = 0; k < count; ++k) {
    data.points.push_back({"P" + std::to_string(k), 2 * k, {1.0 * k, 0.0, 0.0}});
  }
  for (int i = 0; i < 2 * count; ++i) data.mass.push_back({i, i, 1.0});
  data.force.assign(2 * count, 0.0);
  data.initial_velocity.assign(2 * count, 0.0);
  return Model(std::move(data));
}

TEST(DenseVariants, RefuseMatricesOfMoreThanTwoGibibytes) {
  const Model model = falling_points(8200);
  for (const NamedVariant& one : all_variants()) {
    if (!one.variant->dense || one.entry->implementation.role == Role::example) continue;
    for (const Scheme scheme : {Scheme::penalty, Scheme::saddle_point}) {
      StepSettings settings{.penalty = 1e8, .tolerance = 1e-9};
      settings.scheme = scheme;
      EXPECT_THROW((void)create_simulation(*one.variant, model, settings), Unsupported) << one.name;
    }
  }
}

}  // namespace
}  // namespace mbs
