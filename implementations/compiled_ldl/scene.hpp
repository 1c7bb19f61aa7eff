// A model, or several of the same shape, on the rows of a program.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "elements/blocks.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "program.hpp"
#include "scalar.hpp"

namespace mbs::compiled_ldl {

/// The pattern that a scheme's matrix has: multipliers are rows of it in the saddle-point forms,
/// where the points of a constraint couple with each other only by its second derivatives.
Pattern pattern_of(const Model& model, bool multipliers, bool second_derivatives);

inline bool has_multiplier_rows(const StepSettings& s) { return s.scheme != Scheme::penalty; }
/// Or the multistep method, which begins with it and has the same matrix.
inline bool is_rattle(const StepSettings& s) {
  return s.scheme != Scheme::penalty && s.scheme != Scheme::saddle_point;
}
/// What changes of the saddle-point matrix where M is all of its points' block.
Changing changing_of(const Model& model);
/// Compiles that of these settings; `width` as in compile().
Program program_of(const Model& model, const StepSettings& settings, int width);

/// Vectors of coordinates have `extent` numbers: the program's rows, then those of fixed points.
/// The points A, B, C, D of the example of Pairs: of_point = {16, 0, 2, 18}, of_coordinate =
/// {0, 1, 2, 3}, extent = 20.
struct Rows {
  Rows(const Model& model, const Program& program);

  std::vector<int> of_point;
  std::vector<int> of_coordinate;  ///< of an index into q
  int extent = 0;

  [[nodiscard]] bool is_free(int row) const { return row < free_; }

 private:
  int free_ = 0;
};

/// `order`: which of `points` became which pair.
Pairs make_pairs(const std::vector<std::array<int, 2>>& points, const Rows& rows,
                 std::vector<int>& order);
/// Finds their blocks; for pairs that are coupled in the program's pattern.
void place_pairs(Pairs& pairs, const Program& program);
/// Appends the places of its blocks to `places`; none if that is null.
Quad make_quad(const std::array<int, 4>& points, const Rows& rows, const Program& program,
               std::vector<Place>* places);

/// The number that each model has, one a lane; lanes without a model have that of the first.
template <typename S, typename Get>
S of_models(std::span<const Model* const> models, Get get) {
  S value = static_cast<S>(get(*models[0]));
  for (int i = 1; i < static_cast<int>(models.size()); ++i) set_lane(value, i, get(*models[i]));
  return value;
}

}  // namespace mbs::compiled_ldl
