// From the members of a JSON scene to ModelData.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mbs/model.hpp"
#include "scene/json_node.hpp"

namespace mbs {

/// Reads one scene, checking each member for itself and against the points and constraints before
/// it; whether the whole can move is check_scene's business. Throws UsageError.
class SceneReader {
 public:
  /// `root` must outlive the reader.
  explicit SceneReader(JsonNode root) : root_(std::move(root)) {}

  ModelData read();

 private:
  using Terms = std::vector<LinearConstraint::Term>;

  [[nodiscard]] std::vector<JsonNode> list(std::string_view key) const;
  void read_dimension_and_gravity();
  void read_point(const JsonNode& node);
  void read_rod(const JsonNode& node);
  void read_mass(const JsonNode& node);
  void read_constraint(const JsonNode& node);
  void read_dot(const JsonNode& node);
  void read_linear(const JsonNode& node);
  [[nodiscard]] LinearConstraint::Term read_term(const JsonNode& node) const;

  [[nodiscard]] std::array<double, 3> vector(const JsonNode& node) const;
  [[nodiscard]] int point_index(const JsonNode& node) const;
  [[nodiscard]] std::pair<int, int> point_pair(const JsonNode& node) const;
  [[nodiscard]] const Point& point(int index) const {
    return data_.points[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] bool is_fixed(std::pair<int, int> pair) const {
    return point(pair.first).is_fixed() && point(pair.second).is_fixed();
  }
  [[nodiscard]] std::array<double, 3> difference(std::pair<int, int> pair) const;
  void refuse_same_dot(const JsonNode& node, std::pair<int, int> first, std::pair<int, int> second);
  void refuse_same_linear(const JsonNode& node, Terms terms);

  JsonNode root_;
  ModelData data_;
  std::array<double, 3> gravity_{0.0, -9.81, 0.0};  // m/s^2
  int variables_ = 0;
  std::unordered_map<std::string, int> index_of_;
  std::map<std::array<int, 4>, std::string> dots_;  // to the path of the first such constraint
  std::map<std::vector<std::pair<int, double>>, std::string> linears_;
};

}  // namespace mbs
