// Constant mass matrices between points: flexible bodies, as another program may have computed
// them.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "printable.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {

void read_mass_matrix(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"points", "matrix"});
  const JsonNode names = node.get("points"), matrix = node.get("matrix");
  DraftMassMatrix mass{node, {}, {}};
  for (const JsonNode& name : names.items()) {
    const int index = reader.point(name);
    if (std::ranges::find(mass.points, index) != mass.points.end()) {
      name.fail("the point " + in_quotes(name.text()) + " twice", "different points");
    }
    mass.points.push_back(index);
    reader.use(index);
  }
  const auto is_free = [&](int index) { return reader.draft().point(index).hold == Hold::free; };
  if (std::ranges::none_of(mass.points, is_free)) {
    names.fail("no free point", "at least one (a mass elsewhere has no effect)");
  }
  const int size = reader.draft().dimension * static_cast<int>(mass.points.size());
  const std::vector<JsonNode> rows = matrix.items();
  if (rows.size() != static_cast<std::size_t>(size)) {
    matrix.fail(fmt::format("an array of {} rows, one a coordinate of the points", size));
  }
  mass.M.resize(size, size);
  for (int i = 0; i < size; ++i) {
    const std::vector<double> row = rows[static_cast<std::size_t>(i)].numbers(i + 1);
    for (int j = 0; j <= i; ++j) mass.M(i, j) = mass.M(j, i) = row[static_cast<std::size_t>(j)];
  }
  if (mass.M.llt().info() != Eigen::Success) {
    matrix.fail("the lower triangle of a positive definite matrix");
  }
  reader.draft().mass_matrices.push_back(std::move(mass));
}

void lower_mass_matrices(Lowering& scene) {
  const int dimension = scene.draft().dimension;
  for (const DraftMassMatrix& mass : scene.draft().mass_matrices) {
    for (std::size_t i = 0; i < mass.points.size(); ++i) {
      const int at = scene.index(mass.points[i]);
      Vector3 weight{};  // all points fall alike: M times g at each
      for (std::size_t j = 0; j < mass.points.size(); ++j) {
        Matrix3 block{};
        for (int row = 0; row < dimension; ++row) {
          for (int col = 0; col < dimension; ++col) {
            block[static_cast<std::size_t>(row)][static_cast<std::size_t>(col)] = mass.M(
                dimension * static_cast<int>(i) + row, dimension * static_cast<int>(j) + col);
          }
        }
        if (j <= i) scene.mass().add(at, scene.index(mass.points[j]), block);
        weight = weight + multiply(block, scene.draft().gravity);
      }
      scene.mass().push(at, weight);
    }
  }
}

}  // namespace mbs
