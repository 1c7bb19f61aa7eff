// A JSON scene as read: names resolved, nothing lowered yet.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mbs/model.hpp"
#include "model_math/vector3.hpp"
#include "scene/scene.hpp"
#include "scene_file/body/rigid_body.hpp"
#include "scene_file/json_node.hpp"

namespace mbs {

/// Parallel directions are nearer than this in space, where the cosine holds an angle, rad.
inline constexpr double kLeastSpatialAngle = 0.01;

enum class Hold { free, fixed, driven };

/// A point or unit vector. Below, `int` refers to one by its index in SceneDraft::points.
struct DraftPoint {
  std::string name;
  std::optional<JsonNode> node =
      std::nullopt;  ///< where the file has it, or its body; for messages
  bool is_vector = false;
  Hold hold = Hold::free;
  bool is_used = false;    ///< something other than bodies and outputs needs it as a coordinate
  bool is_loaded = false;  ///< a mass or force acts on it
  bool is_output = false;  ///< an output names it
  bool is_own = false;     ///< made for a body, which names it
  std::optional<Vector3> position = std::nullopt;  ///< a vector's: its direction, length 1
  std::optional<Vector3> velocity = std::nullopt;
  bool is_placed = false;   ///< `position` is where a body's pose has it, not what the file says
  bool is_carried = false;  ///< the same of `velocity`
  std::array<TimeFunction, 3> motion = {};  ///< of a driven one
  std::vector<int> bodies = {};  ///< that have it: ascending indices into SceneDraft::bodies
  std::size_t item = 0;          ///< of the first of these bodies
  bool is_member = false;        ///< of a body's basis or further items
  int index = -1;                ///< into Model::points(), once numbered; -1: not in the model
  int marker = -1;               ///< then: into Elements::markers
};

struct DraftBody {
  struct Item {
    int point = 0;
    Vector3 local{};  ///< m; a unit vector if the point is one
  };
  JsonNode node;
  std::string name;
  Inertia inertia;
  std::vector<Item> items;
  bool has_pose = false;                           ///< given, perhaps without what follows
  std::optional<Vector3> position = std::nullopt;  ///< of the local origin, given
  std::optional<Vector3> rotation = std::nullopt;  ///< axis times angle (planar: along z), given
  std::optional<Vector3> velocity = std::nullopt;  ///< of the local origin, given
  std::optional<Vector3> spin = std::nullopt;      ///< angular velocity, given
  std::vector<std::size_t> basis = {};  ///< items whose coordinates are the body's: choose_bases()
  std::vector<std::size_t> further = {};  ///< items with coordinates and linear constraints
  double size = 0.0;                      ///< m; how far the body reaches
};

/// From `from` to `to`, or the unit vector `to` alone (`from` = -1).
struct DraftDirection {
  int from = -1, to = -1;
};

struct DraftRod {
  JsonNode node;
  std::string name;
  int a = 0, b = 0;
  double mass = 0.0;
  std::optional<double> length = std::nullopt;
};

struct DraftMass {
  JsonNode node;
  int point = 0;
  double mass = 0.0;
};

struct DraftMassMatrix {
  JsonNode node;
  std::vector<int> points;
  Eigen::MatrixXd M;  ///< kg; x, y (and z) of the first point first
};

struct ConstraintKind;

struct DraftConstraint {
  struct Term {
    int point = 0, axis = 0;
    double coefficient = 0.0;
  };
  JsonNode node;
  std::string name;
  const ConstraintKind* kind = nullptr;
  std::vector<int> points = {};  ///< distance, coincident: two; on_line: the point, then the line
  DraftDirection first = {}, second = {};  ///< dot: from - to is what the constraint multiplies
  int axis = -1;                           ///< joints in space: parallel to `direction`
  int direction = -1;                      ///< on_line, joints in space: along the line
  std::array<int, 2> normals{-1, -1};      ///< then: of a moving line, the vectors across it
  std::vector<Term> terms = {};
  std::optional<TimeFunction> value = std::nullopt;
};

struct DraftSpring {
  JsonNode node;
  std::string name;
  int a = 0, b = 0;
  TimeFunction stiffness = {}, damping = {};
  std::optional<double> length = std::nullopt;
};

struct DraftTorsionSpring {
  JsonNode node;
  std::string name;
  DraftDirection from = {}, to = {};
  int axis = -1;
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> angle = std::nullopt;
};

struct DraftForce {
  JsonNode node;
  int point = 0;
  Vector3 force{};                          ///< the constant part
  std::array<TimeFunction, 3> driven = {};  ///< the other: one axis has either
  int pusher = -1;  ///< then: the hidden driven point that has it, an index into Model::points()
};

struct DraftTorque {
  JsonNode node;
  std::string name;
  int body = -1;               ///< planar: turned as a whole, by its basis
  DraftDirection direction{};  ///< else
  int axis = -1;
  TimeFunction torque = {};
};

struct DraftForceLaw {
  JsonNode node;
  std::string name;
  int a = 0, b = 0;
  Law law = {};
};

struct DraftTorqueLaw {
  JsonNode node;
  std::string name;
  DraftDirection from = {}, to = {};
  int axis = -1;
  Law law = {};
};

struct DraftOutput {
  JsonNode node;
  Output output;           ///< refers to draft points
  std::string constraint;  ///< of a constraint force
};

struct SceneDraft {
  int dimension = 2;
  Vector3 gravity{0.0, -9.81, 0.0};
  std::vector<DraftPoint> points;
  std::vector<DraftBody> bodies;
  std::vector<DraftRod> rods;
  std::vector<DraftMass> masses;
  std::vector<DraftMassMatrix> mass_matrices;
  std::vector<DraftConstraint> constraints;
  std::vector<DraftSpring> springs;
  std::vector<DraftTorsionSpring> torsion_springs;
  std::vector<DraftForce> forces;
  std::vector<DraftTorque> torques;
  std::vector<DraftForceLaw> force_laws;
  std::vector<DraftTorqueLaw> torque_laws;
  std::vector<DraftOutput> outputs;
  std::vector<Driver> drivers;
  std::vector<Input> inputs;
  std::optional<double> largest_correction;
  std::unordered_map<std::string, int> index_of;  ///< points and vectors by name
  std::unordered_map<std::string, int> body_of;
  std::unordered_map<std::string, std::string> output_of;  ///< where the file has it, by name

  [[nodiscard]] DraftPoint& point(int index) { return points[static_cast<std::size_t>(index)]; }
  [[nodiscard]] const DraftPoint& point(int index) const {
    return points[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] DraftBody& body(int index) { return bodies[static_cast<std::size_t>(index)]; }
  [[nodiscard]] const DraftBody& body(int index) const {
    return bodies[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] bool is_fixed(const DraftDirection& d) const {
    return point(d.to).hold == Hold::fixed && (d.from < 0 || point(d.from).hold == Hold::fixed);
  }
  [[nodiscard]] bool is_free(const DraftDirection& d) const {  ///< at one end at least
    return point(d.to).hold == Hold::free || (d.from >= 0 && point(d.from).hold == Hold::free);
  }
};

/// Gives a body a point or vector of its own, named "BODY.suffix" or, where that is taken, with
/// underscores behind. Returns its index in draft.points.
int add_own(SceneDraft& draft, int body, const Vector3& local, bool is_vector,
            const std::string& suffix);

/// A body that has all of these points and that `accept` takes; -1: none.
template <typename Accept>
int common_body(const SceneDraft& draft, const std::vector<int>& points, Accept accept) {
  const int rarest = *std::min_element(points.begin(), points.end(), [&](int x, int y) {
    return draft.point(x).bodies.size() < draft.point(y).bodies.size();
  });
  for (const int body : draft.point(rarest).bodies) {
    const bool has_all = std::all_of(points.begin(), points.end(), [&](int point) {
      const std::vector<int>& bodies = draft.point(point).bodies;
      return std::binary_search(bodies.begin(), bodies.end(), body);
    });
    if (has_all && accept(body)) return body;
  }
  return -1;
}
int common_body(const SceneDraft& draft, const std::vector<int>& points);

/// A vector of length 1 at a right angle.
Vector3 any_across(const Vector3& x);

}  // namespace mbs
