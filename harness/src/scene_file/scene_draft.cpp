// What reading and lowering do to a draft alike.
#include "scene_file/scene_draft.hpp"

#include <cmath>

namespace mbs {

int add_own(SceneDraft& draft, int body, const Vector3& local, bool is_vector,
            const std::string& suffix) {
  DraftBody& owner = draft.body(body);
  const int index = static_cast<int>(draft.points.size());
  std::string name = owner.name + '.' + suffix;
  while (!draft.index_of.emplace(name, index).second) name += '_';
  DraftPoint point{name, owner.node, is_vector};
  point.is_own = true;
  point.bodies.push_back(body);
  point.item = owner.items.size();
  draft.points.push_back(std::move(point));
  owner.items.push_back({index, local});
  return index;
}

int common_body(const SceneDraft& draft, const std::vector<int>& points) {
  return common_body(draft, points, [](int) { return true; });
}

Vector3 any_across(const Vector3& x) {
  std::size_t least = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (std::abs(x[axis]) < std::abs(x[least])) least = axis;
  }
  Vector3 unit{};
  unit[least] = 1.0;
  const Vector3 across = cross(x, unit);
  return (1.0 / norm(across)) * across;
}

}  // namespace mbs
