// Fuzz target: any bytes are either a scene or one line that says what is wrong with it.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "model_math/kinematics.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "usage_error.hpp"

namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz_scene: %s\n", what);
  std::abort();
}

/// What reads can also be calculated with: its start, its forces, its drivers a little later.
void use(const mbs::SceneData& data) {
  const mbs::Model model(data.model);
  const auto q = model.initial_position(), v = model.initial_velocity();
  for (const double value : q) require(std::isfinite(value), "a start is not finite");
  for (const double value : v) require(std::isfinite(value), "a velocity is not finite");
  std::vector<double> force(q.size()), phi(static_cast<std::size_t>(model.constraints()));
  for (const double t : {0.0, 0.37}) {
    mbs::applied_force(model, t, q, v, force);
    mbs::evaluate_constraints(model, t, q, phi);
    mbs::constraint_curvature(model, t, q, v, phi);
  }
  require(mbs::kinetic_energy(model, v) >= 0.0, "M is not positive definite");
  const auto known = static_cast<int>(model.points().size() + data.elements.markers.size());
  for (const mbs::Output& output : data.elements.outputs) {
    bool refers = output.point < known;
    for (const int row : output.rows) refers = refers && row >= 0 && row < model.constraints();
    require(refers, "an output refers to nothing");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  try {
    use(mbs::parse_scene(text, "fuzz.json"));
  } catch (const mbs::UsageError& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz.json: "), "a message does not name the file");
    require(message.find('\n') == std::string_view::npos, "a message has several lines");
  }
  return 0;
}
