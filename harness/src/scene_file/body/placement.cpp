// Bodies are placed one after another, as soon as enough of their points are.
#include "scene_file/body/placement.hpp"

#include <fmt/format.h>

#include <cmath>
#include <deque>

#include "printable.hpp"
#include "scene_file/body/rigid_fit.hpp"

namespace mbs {
namespace {

class Placement {
 public:
  explicit Placement(SceneDraft& draft)
      : draft_(draft), poses_(draft.bodies.size()), is_waiting_(draft.bodies.size(), false) {}

  void run() {
    for (DraftPoint& point : draft_.points) place_driven(point);
    for (int i = 0; i < bodies(); ++i) place_given(i);
    for (int i = 0; i < bodies(); ++i) wait(i);
    place_fitted();
    for (int i = 0; i < bodies(); ++i) place_at_origin(i);
    refuse_open_places();
    for (int i = 0; i < bodies(); ++i) {
      if (draft_.dimension == 3) {
        refuse_mirror_image(i);
      } else {
        refuse_planar_mirror_image(i);
      }
      move(i);
    }
  }

 private:
  [[nodiscard]] int bodies() const { return static_cast<int>(draft_.bodies.size()); }
  [[nodiscard]] std::optional<Pose>& pose(int body) {
    return poses_[static_cast<std::size_t>(body)];
  }

  void place_driven(DraftPoint& point) const {
    if (point.hold != Hold::driven) return;
    point.position.emplace();
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(draft_.dimension); ++axis) {
      (*point.position)[axis] = point.motion[axis].at(0.0).value;
    }
  }

  /// Of a pose that the file states: as it says, else as the places that the file gives show it,
  /// else none.
  [[nodiscard]] Matrix3 rotation(const DraftBody& body) const {
    if (body.rotation) return rotation_matrix(*body.rotation);
    std::vector<Sighting> seen = sightings(body, true);
    if (body.position) seen.push_back({{}, *body.position});
    const auto fitted = fit_pose(seen, draft_.dimension, body.size);
    return fitted ? fitted->R : Pose{}.R;
  }

  /// A pose that the file states; without a position it hangs on the first point that has one.
  void place_given(int index) {
    const DraftBody& body = draft_.body(index);
    if (!body.has_pose) return;
    Pose given;
    given.R = rotation(body);
    if (body.position) {
      given.origin = *body.position;
    } else {
      const DraftBody::Item* anchor = nullptr;
      for (const DraftBody::Item& item : body.items) {
        const DraftPoint& point = draft_.point(item.point);
        if (!point.is_vector && point.position && anchor == nullptr) anchor = &item;
      }
      if (anchor == nullptr) return;  // perhaps once its neighbours are placed
      given.origin = *draft_.point(anchor->point).position - multiply(given.R, anchor->local);
    }
    set_pose(index, given);
  }

  void wait(int body) {
    if (is_waiting_[static_cast<std::size_t>(body)]) return;
    is_waiting_[static_cast<std::size_t>(body)] = true;
    waiting_.push_back(body);
  }

  void set_pose(int index, const Pose& given) {
    pose(index) = given;
    for (const DraftBody::Item& item : draft_.body(index).items) {
      DraftPoint& point = draft_.point(item.point);
      if (point.position) continue;
      point.position = given.place(item.local, point.is_vector);
      point.is_placed = true;
      for (const int other : point.bodies) wait(other);
    }
  }

  /// A pose without a position, of a body that hangs on nothing.
  void place_at_origin(int index) {
    if (pose(index) || !draft_.body(index).has_pose) return;
    set_pose(index, {{}, rotation(draft_.body(index))});
    place_fitted();
  }

  void place_fitted() {
    while (!waiting_.empty()) {
      const int index = waiting_.front();
      waiting_.pop_front();
      is_waiting_[static_cast<std::size_t>(index)] = false;
      if (pose(index)) continue;
      if (draft_.body(index).has_pose) {
        place_given(index);
      } else if (const auto fitted = fit_pose(sightings(draft_.body(index)), draft_.dimension,
                                              draft_.body(index).size)) {
        set_pose(index, *fitted);
      }
    }
  }

  /// Of what has a position, with `only_given` of what does not have it from a body.
  [[nodiscard]] std::vector<Sighting> sightings(const DraftBody& body,
                                                bool only_given = false) const {
    std::vector<Sighting> result;
    for (const DraftBody::Item& item : body.items) {
      const DraftPoint& point = draft_.point(item.point);
      if (!point.position || (only_given && point.is_placed)) continue;
      result.push_back({item.local, *point.position, point.is_vector,
                        point.is_vector && point.hold == Hold::fixed});
    }
    return result;
  }

  void refuse_open_places() const {
    for (const DraftPoint& point : draft_.points) {
      if (point.position) continue;
      if (point.bodies.empty()) {
        point.node->fail(
            fmt::format("no key \"{}\"", point.is_vector ? "direction" : "position"),
            "an object that has it, unless a body has the point or vector and places it");
      }
      const DraftBody& body = draft_.body(point.bodies.front());
      std::string known;
      for (const DraftBody::Item& item : body.items) {
        const DraftPoint& other = draft_.point(item.point);
        if (other.position) known += (known.empty() ? "" : ", ") + printable(other.name);
      }
      body.node.fail(
          fmt::format("no place for {}: of the body's points {} one", in_quotes(point.name),
                      known.empty() ? "none has" : "only " + known + " have"),
          draft_.dimension == 2
              ? "a \"pose\", or positions of two of its points"
              : "a \"pose\", or positions of three of its points that are not on one line, or of "
                "points and unit vectors that show two directions");
    }
  }

  /// Four points and the distances between them fit a body and its mirror image alike.
  void refuse_mirror_image(int index) const {
    const DraftBody& body = draft_.body(index);
    const DraftBody::Item& origin = body.items[body.basis[0]];
    std::array<Vector3, 3> local, global;
    for (std::size_t k = 0; k < 3; ++k) {
      const DraftBody::Item& item = body.items[body.basis[k + 1]];
      const DraftPoint& point = draft_.point(item.point);
      local[k] = point.is_vector ? item.local : item.local - origin.local;
      global[k] = point.is_vector ? *point.position
                                  : *point.position - *draft_.point(origin.point).position;
    }
    const double there = dot(cross(local[0], local[1]), local[2]);
    const double here = dot(cross(global[0], global[1]), global[2]);
    if (here * there > 0.0 || here == 0.0) return;
    fail_mirror_image(body);
  }

  /// Of the positions that do not come from the body itself: as complex numbers about their
  /// middles, |sum conj(local) global| is how well the body fits them, |sum local global| its
  /// mirror image; on a line these are equal.
  void refuse_planar_mirror_image(int index) const {
    const std::vector<Sighting> seen = sightings(draft_.body(index), true);
    Vector3 local{}, global{};
    for (const Sighting& sighting : seen) {
      const double share = 1.0 / static_cast<double>(seen.size());
      local = local + share * sighting.local;
      global = global + share * sighting.global;
    }
    Vector3 as_is{}, mirrored{};
    for (const Sighting& sighting : seen) {
      const Vector3 x = sighting.local - local, y = sighting.global - global;
      as_is = as_is + Vector3{dot(x, y), cross(x, y)[2], 0.0};
      mirrored = mirrored + Vector3{x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0], 0.0};
    }
    constexpr double kMargin = 1.001;  // what lies nearly on a line is not judged by its rounding
    if (norm(mirrored) > kMargin * norm(as_is)) fail_mirror_image(draft_.body(index));
  }

  [[noreturn]] static void fail_mirror_image(const DraftBody& body) {
    body.node.fail("points and vectors that start as the mirror image of the body's",
                   "positions that turning and moving the body gives");
  }

  void move(int index) {
    const DraftBody& body = draft_.body(index);
    const std::optional<Twist> twist = stated_twist(index);
    if (!twist) return;
    for (const DraftBody::Item& item : body.items) {
      DraftPoint& point = draft_.point(item.point);
      if (point.velocity || point.hold != Hold::free) continue;
      point.velocity =
          point.is_vector ? cross(twist->spin, *point.position) : twist->of_point(*point.position);
      point.is_carried = true;
    }
  }

  /// What the file says of the body's motion, or what that of its points and vectors amounts to.
  std::optional<Twist> stated_twist(int index) {
    const DraftBody& body = draft_.body(index);
    std::vector<Sighting> seen;
    const Sighting* anchor = nullptr;
    bool any_stated = false;
    for (const DraftBody::Item& item : body.items) {
      const DraftPoint& point = draft_.point(item.point);
      const bool is_stated = point.velocity && !point.is_carried;
      if (point.hold == Hold::free && !is_stated) continue;
      any_stated = any_stated || is_stated;
      seen.push_back(
          {*point.position, is_stated ? *point.velocity : known_velocity(point), point.is_vector});
    }
    for (const Sighting& sighting : seen) {
      if (!sighting.is_vector && anchor == nullptr) anchor = &sighting;
    }
    if (body.velocity) {
      if (!pose(index)) {
        body.node.get("velocity")
            .fail("the velocity of a body whose pose is open", "one beside a \"pose\"");
      }
      return Twist{pose(index)->origin, *body.velocity, body.spin.value_or(Vector3{})};
    }
    if (body.spin && anchor != nullptr) return Twist{anchor->local, anchor->global, *body.spin};
    if (body.spin) return Twist{centre(index), {}, *body.spin};
    return any_stated ? fit_twist(seen, draft_.dimension) : std::nullopt;
  }

  [[nodiscard]] Vector3 centre(int index) {
    return pose(index) ? pose(index)->place(draft_.body(index).inertia.centre, false) : Vector3{};
  }

  static Vector3 known_velocity(const DraftPoint& point) {
    Vector3 velocity{};
    if (point.hold != Hold::driven) return velocity;
    for (std::size_t axis = 0; axis < 3; ++axis) velocity[axis] = point.motion[axis].at(0.0).rate;
    return velocity;
  }

  SceneDraft& draft_;
  std::vector<std::optional<Pose>> poses_;
  std::deque<int> waiting_;  // bodies to place, each once
  std::vector<bool> is_waiting_;
};

}  // namespace

void place(SceneDraft& draft) { Placement(draft).run(); }

}  // namespace mbs
