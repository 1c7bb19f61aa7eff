// Distances, then angles, then which way round.
#include "scene_file/body/shared_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "printable.hpp"

namespace mbs {
namespace {

class ShapeComparison {
 public:
  ShapeComparison(const SceneDraft& draft, int body, int other)
      : draft_(draft), bodies_{&draft.body(body), &draft.body(other)} {}

  void run(const std::vector<int>& points) {
    for (const int point : points) {
      (draft_.point(point).is_vector ? directions_ : places_).push_back(seen(point));
    }
    compare_distances();
    compare_angles();
    compare_sides();
  }

 private:
  /// A point, or a direction: its local coordinates in both bodies.
  struct Seen {
    std::string name;
    std::array<Vector3, 2> local{};
  };

  [[nodiscard]] Seen seen(int point) const {
    Seen result{printable(draft_.point(point).name), {}};
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& items = bodies_[side]->items;
      result.local[side] = std::find_if(items.begin(), items.end(), [&](const auto& item) {
                             return item.point == point;
                           })->local;
    }
    return result;
  }

  [[noreturn]] void fail(const std::string& here, const std::string& there) const {
    bodies_[0]->node.fail(fmt::format("{} in {}, {} in {} {}", here, in_quotes(bodies_[0]->name),
                                      there, bodies_[1]->node.path(), in_quotes(bodies_[1]->name)),
                          "one shape of the points and vectors that two bodies share");
  }

  void compare_distances() const {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        std::array<double, 2> apart{};
        for (std::size_t side = 0; side < 2; ++side) {
          apart[side] = norm(places_[i].local[side] - places_[k].local[side]);
        }
        if (std::abs(apart[0] - apart[1]) <= kShapeTolerance * bodies_[0]->size) continue;
        fail(fmt::format("{} and {} {:.9g} m apart", places_[k].name, places_[i].name, apart[0]),
             fmt::format("{:.9g} m", apart[1]));
      }
    }
  }

  /// Between vectors, and of these with directions of points, which join `directions_` here.
  void compare_angles() {
    const std::size_t vectors = directions_.size();
    for (std::size_t i = 1; i < places_.size(); ++i) {
      Seen edge{places_[0].name + '-' + places_[i].name, {}};
      for (std::size_t side = 0; side < 2; ++side) {
        edge.local[side] =
            (1.0 / bodies_[0]->size) * (places_[i].local[side] - places_[0].local[side]);
      }
      directions_.push_back(std::move(edge));
    }
    for (std::size_t k = 0; k < vectors; ++k) {
      for (std::size_t i = k + 1; i < directions_.size(); ++i) {
        std::array<double, 2> cosine{}, angle{};
        for (std::size_t side = 0; side < 2; ++side) {
          const Vector3 &x = directions_[k].local[side], &y = directions_[i].local[side];
          cosine[side] = dot(x, y);
          angle[side] = std::atan2(norm(cross(x, y)), cosine[side]);
        }
        if (std::abs(cosine[0] - cosine[1]) <= kShapeTolerance) continue;
        fail(fmt::format("{} and {} at {:.9g} rad", directions_[k].name, directions_[i].name,
                         angle[0]),
             fmt::format("{:.9g} rad", angle[1]));
      }
    }
  }

  void compare_sides() const {
    const std::size_t count = directions_.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = i + 1; k < count; ++k) {
        if (draft_.dimension == 2) compare_turn(i, k, nullptr);
        for (std::size_t l = k + 1; draft_.dimension == 3 && l < count; ++l) {
          compare_turn(i, k, &directions_[l]);
        }
      }
    }
  }

  /// The sign of the area or volume that directions span.
  void compare_turn(std::size_t i, std::size_t k, const Seen* third) const {
    std::array<double, 2> turn{};
    for (std::size_t side = 0; side < 2; ++side) {
      const Vector3 across = cross(directions_[i].local[side], directions_[k].local[side]);
      turn[side] = third == nullptr ? across[2] : dot(across, third->local[side]);
    }
    if (std::abs(turn[0] - turn[1]) <= kShapeTolerance || turn[0] * turn[1] >= 0.0) return;
    const std::string names =
        fmt::format("{}, {}{}{}", directions_[i].name, directions_[k].name,
                    third == nullptr ? "" : ", ", third == nullptr ? "" : third->name);
    const auto hand = [](double x) { return x > 0.0 ? "right-handed" : "left-handed"; };
    const auto sense = [](double x) { return x > 0.0 ? "counter-clockwise" : "clockwise"; };
    if (third == nullptr) fail(names + ' ' + sense(turn[0]), sense(turn[1]));
    fail(names + ' ' + hand(turn[0]), hand(turn[1]));
  }

  const SceneDraft& draft_;
  std::array<const DraftBody*, 2> bodies_;
  std::vector<Seen> places_, directions_;
};

}  // namespace

void check_same_shape(const SceneDraft& draft, int body, int other,
                      const std::vector<int>& points) {
  ShapeComparison(draft, body, other).run(points);
}

}  // namespace mbs
