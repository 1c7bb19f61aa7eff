// Greedy choice by distance from the span of what is chosen already.
#include "scene_file/body/body_basis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "printable.hpp"

namespace mbs {
namespace {

/// Of a body's size: nearer to the span of the others, a needed item makes no good basis.
constexpr double kAxesApart = 0.1;
/// Items held to others by another body's constraints come first, unless others lie that much
/// farther apart: what that body says need not be said again.
constexpr double kSharedBonus = 4.0;
/// The same for fixed items, which must be in the basis if they add anything to it.
constexpr double kKnownApart = 1e-6;

class BasisChoice {
 public:
  BasisChoice(SceneDraft& draft, int index)
      : draft_(draft), index_(index), members_(draft.dimension == 2 ? 2 : 4) {}

  void run() {
    sort_items();
    check_driven();
    body().size = size();
    choose_origin();
    for (const std::size_t i : known_) consider(i, kKnownApart);
    refuse_immovable();
    if (body().basis.size() == 3 && !is_known(origin_)) complete_orientation();
    while (body().basis.size() < members_) {
      if (!take_farthest()) add_own_point();
    }
    std::copy_if(needed_.begin(), needed_.end(), std::back_inserter(body().further),
                 [&](std::size_t i) { return !is_in_basis(i); });
    for (const std::vector<std::size_t>* items : {&body().basis, &body().further}) {
      for (const std::size_t i : *items) draft_.point(body().items[i].point).is_member = true;
    }
  }

 private:
  [[nodiscard]] DraftBody& body() { return draft_.body(index_); }
  [[nodiscard]] const DraftPoint& point(std::size_t item) {
    return draft_.point(body().items[item].point);
  }
  [[nodiscard]] bool is_known(std::size_t item) { return point(item).hold != Hold::free; }
  [[nodiscard]] bool is_in_basis(std::size_t item) {
    return std::find(body().basis.begin(), body().basis.end(), item) != body().basis.end();
  }

  void sort_items() {
    for (std::size_t i = 0; i < body().items.size(); ++i) {
      if (is_known(i)) {
        known_.push_back(i);
      } else if (is_needed(point(i))) {
        needed_.push_back(i);
      }
    }
  }

  /// A driven point beside another fixed or driven one would prescribe the distance between them.
  void check_driven() {
    int points = 0;
    const DraftPoint* driven = nullptr;
    for (const std::size_t i : known_) {
      if (point(i).is_vector) continue;
      ++points;
      if (point(i).hold == Hold::driven) driven = &point(i);
    }
    if (driven == nullptr || points == 1) return;
    body().node.fail(
        fmt::format("the driven point {} among {} fixed or driven points", in_quotes(driven->name),
                    points),
        "one driven point a body (fix a vector or drive an angle to hold its direction)");
  }

  [[nodiscard]] double size() {
    const Inertia& inertia = body().inertia;
    double size = radius_of_gyration(inertia, draft_.dimension);
    for (const std::vector<std::size_t>* items : {&known_, &needed_}) {
      for (const std::size_t i : *items) {
        if (!point(i).is_vector) {
          size = std::max(size, norm(body().items[i].local - inertia.centre));
        }
      }
    }
    return size;
  }

  /// The basis' first point: a known one, else the one farthest from the centre, else the centre.
  void choose_origin() {
    const auto is_point = [&](std::size_t i) { return !point(i).is_vector; };
    const auto known = std::find_if(known_.begin(), known_.end(), is_point);
    if (known != known_.end()) {
      origin_ = *known;
    } else {
      double farthest = -1.0;
      for (const std::size_t i : needed_) {
        const double away = norm(body().items[i].local - body().inertia.centre);
        if (!is_point(i) || away <= farthest) continue;
        farthest = away;
        origin_ = i;
      }
      if (farthest < 0.0) {
        add_own(draft_, index_, body().inertia.centre, false, "o");
        origin_ = body().items.size() - 1;
      }
    }
    body().basis.push_back(origin_);
  }

  /// What an item adds to the directions from the origin that are chosen, in units of the size.
  [[nodiscard]] Vector3 residual(std::size_t item) {
    const DraftBody::Item& it = body().items[item];
    Vector3 rest = point(item).is_vector
                       ? it.local
                       : (1.0 / body().size) * (it.local - body().items[origin_].local);
    for (int pass = 0; pass < 2; ++pass) rest = across(rest);
    return rest;
  }

  [[nodiscard]] Vector3 across(Vector3 x) const {
    if (draft_.dimension == 2) return directions_.empty() ? x : Vector3{};
    for (const Vector3& e : directions_) x = x - dot(e, x) * e;
    return x;
  }

  bool consider(std::size_t item, double apart) {
    if (item == origin_) return false;
    const Vector3 rest = residual(item);
    const double length = norm(rest);
    if (!(length > apart)) return false;
    directions_.push_back((1.0 / length) * rest);
    body().basis.push_back(item);
    return true;
  }

  bool take_farthest() {
    std::size_t best = origin_;
    double farthest = kAxesApart;
    for (const std::size_t i : needed_) {
      const double away = norm(residual(i));
      const double counted = is_held_elsewhere(i) ? kSharedBonus * away : away;
      if (i == origin_ || !(away > kAxesApart) || counted <= farthest) continue;
      farthest = counted;
      best = i;
    }
    return best != origin_ && consider(best, kAxesApart);
  }

  /// A shared unit vector, whose length the other body holds, or a point whose distance to a member
  /// of the basis another body holds.
  [[nodiscard]] bool is_held_elsewhere(std::size_t item) {
    if (point(item).bodies.size() < 2) return false;
    if (point(item).is_vector) return true;
    const auto other = [&](int body) { return body != index_; };
    return std::any_of(body().basis.begin(), body().basis.end(), [&](std::size_t member) {
      return !point(member).is_vector &&
             common_body(draft_, {body().items[item].point, body().items[member].point}, other) >=
                 0;
    });
  }

  void refuse_immovable() {
    const std::size_t rank = directions_.size();
    if (!is_known(origin_) || rank < (draft_.dimension == 2 ? 1u : 2u)) return;
    std::string names;
    for (const std::size_t i : body().basis) {
      names += (names.empty() ? "" : ", ") + in_quotes(point(i).name);
    }
    body().node.fail("a body that cannot move: " + names + " are fixed or driven",
                     draft_.dimension == 2
                         ? "one fixed or driven point a body"
                         : "fixed points and vectors along one line (a fixed axis) a body");
  }

  /// Two fixed vectors hold the orientation: a constant third one completes it.
  void complete_orientation() {
    add_own(draft_, index_, cross(directions_[0], directions_[1]), true, "w");
    draft_.points.back().hold = Hold::fixed;
    consider(body().items.size() - 1, kAxesApart);
  }

  /// A point at the body's size from the origin, along that local axis which is most across.
  void add_own_point() {
    Vector3 best{};
    char name = 'x';
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(draft_.dimension); ++axis) {
      Vector3 unit{};
      unit[axis] = 1.0;
      const Vector3 rest = across(across(unit));
      if (norm(rest) <= norm(best) + kKnownApart) continue;
      best = rest;
      name = static_cast<char>('x' + axis);
    }
    const DraftBody& owner = body();
    const Vector3 local = owner.items[origin_].local + (owner.size / norm(best)) * best;
    add_own(draft_, index_, local, false, std::string(1, name));
    if (consider(body().items.size() - 1, kAxesApart)) return;
    owner.node.fail(fmt::format("a size of {:.3g} m, which rounding of its local coordinates hides",
                                owner.size),
                    "a larger inertia, or a local origin near its centre");
  }

  SceneDraft& draft_;
  int index_;
  std::size_t members_;
  std::vector<std::size_t> known_, needed_;
  std::size_t origin_ = 0;
  std::vector<Vector3> directions_;  // orthonormal; what the chosen items span from the origin
};

}  // namespace

bool is_needed(const DraftPoint& point) {
  return point.hold != Hold::free || point.is_used || point.bodies.size() > 1;
}

void choose_bases(SceneDraft& draft) {
  for (std::size_t i = 0; i < draft.bodies.size(); ++i) {
    BasisChoice(draft, static_cast<int>(i)).run();
  }
}

}  // namespace mbs
