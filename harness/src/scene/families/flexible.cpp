// A chain of flexible beams, each with a mass matrix that couples all of its nodes.
#include <cmath>

#include "scene/families/beam_mass.hpp"
#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"

namespace mbs {

SceneSize flexible_size(const FamilyValues& values) {
  const long spans = long{values[0]} * (values[1] - 1);
  return {2 * spans, spans};
}

/// Hangs straight and leans, hinged end to end. Nodes keep their distance; torsion springs between
/// spans bend it. The mass is to the right of the line of nodes, as in a girder hung by its chord:
/// so x and y of all nodes are coupled.
nlohmann::json flexible_document(const FamilyValues& values) {
  constexpr double kLength = 4.0, kMass = 10.0, kLean = 0.05;  // m, kg a beam, rad
  constexpr double kOffset = -0.1, kGyration = 0.05;           // m
  constexpr double kBending = 60.0;                            // N m^2
  const int beams = values[0], spans = values[1] - 1;
  const double span = kLength / spans;
  SceneWriter scene;
  const Eigen::MatrixXd M = beam_mass({values[1], kLength, kMass, kOffset, kGyration});
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    nlohmann::json row = nlohmann::json::array();
    for (Eigen::Index j = 0; j <= i; ++j) row.push_back(M(i, j));
    rows.push_back(std::move(row));
  }
  const Vector3 along = span * Vector3{std::sin(kLean), -std::cos(kLean), 0.0};
  const auto name = [](int i) { return numbered("P", i); };
  for (int i = 0; i <= beams * spans; ++i) {
    if (i == 0) {
      scene.fixed(name(i), {});
    } else {
      scene.point(name(i), double(i) * along);
      scene.rod(name(i - 1), name(i), 0.0);
    }
    if (i % spans == 0) continue;  // a hinge or an end
    scene.add("torsion_springs", {{"name", numbered("bend", i)},
                                  {"from", {name(i - 1), name(i)}},
                                  {"to", {name(i), name(i + 1)}},
                                  {"stiffness", kBending / span},
                                  {"angle", 0.0}});
  }
  for (int b = 0; b < beams; ++b) {
    nlohmann::json nodes = nlohmann::json::array();
    for (int i = 0; i <= spans; ++i) nodes.push_back(name(b * spans + i));
    scene.add("mass_matrices", {{"points", nodes}, {"matrix", rows}});
  }
  scene.position_output(name(beams * spans));
  return std::move(scene).finish();
}

}  // namespace mbs
