// What families share: a scene's document, written as a user would.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "model_math/vector3.hpp"

namespace mbs {

/// Lists of harness/scenes/README.md, an item a call. Vectors lose their z in the plane.
class SceneWriter {
 public:
  explicit SceneWriter(int dimension = 2) : dimension_(dimension) {
    document_["dimension"] = dimension;
    document_["points"] = nlohmann::json::array();
  }

  [[nodiscard]] nlohmann::json vector(const Vector3& x) const {
    return dimension_ == 2 ? nlohmann::json{x[0], x[1]} : nlohmann::json{x[0], x[1], x[2]};
  }

  void gravity(const Vector3& g) { document_["gravity"] = vector(g); }
  void fixed(const std::string& name, const Vector3& r) {
    add("points", {{"name", name}, {"position", vector(r)}, {"fixed", true}});
  }
  void point(const std::string& name, const Vector3& r) {
    add("points", {{"name", name}, {"position", vector(r)}});
  }
  void point(const std::string& name, const Vector3& r, const Vector3& v) {
    add("points", {{"name", name}, {"position", vector(r)}, {"velocity", vector(v)}});
  }
  void rod(const std::string& a, const std::string& b, double mass) {  // kg
    add("rods", {{"name", a + "-" + b}, {"between", {a, b}}, {"mass", mass}});
  }
  void mass(const std::string& at, double mass) { add("masses", {{"point", at}, {"mass", mass}}); }
  /// As long as at the start, in N/m.
  void spring(const std::string& a, const std::string& b, double stiffness) {
    add("springs", {{"name", a + "~" + b}, {"between", {a, b}}, {"stiffness", stiffness}});
  }
  /// `length` without force, m.
  void spring(const std::string& a, const std::string& b, double stiffness, double length,
              double damping = 0.0) {
    add("springs", {{"name", a + "~" + b},
                    {"between", {a, b}},
                    {"stiffness", stiffness},
                    {"damping", damping},
                    {"length", length}});
  }
  void position_output(const std::string& point) {
    add("outputs", {{"name", point}, {"position", point}});
  }
  /// An item of any list.
  void add(const char* list, nlohmann::json item) { document_[list].push_back(std::move(item)); }

  /// With the total energy as the last output.
  nlohmann::json finish() && {
    add("outputs", {{"name", "energy"}, {"energy", "total"}});
    return std::move(document_);
  }

 private:
  int dimension_;
  nlohmann::json document_;
};

/// "P7"
template <class Index>
std::string numbered(const char* name, Index index) {
  return fmt::format("{}{}", name, index);
}

}  // namespace mbs
