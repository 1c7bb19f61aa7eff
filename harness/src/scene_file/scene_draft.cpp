// What reading and lowering do to a draft alike.
#include "scene_file/scene_draft.hpp"

#include <fmt/format.h>

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

}  // namespace mbs
