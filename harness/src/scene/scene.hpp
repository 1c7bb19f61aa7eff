// A scene: what the user asked for, lowered to a Model.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "mbs/model.hpp"

namespace mbs {

/// Artificial non-zeros in M (stored zeros) that raise the tangent's fill without changing physics.
struct Fill {
  double asked = 0.0;      ///< share of the tangent's n^2 positions, 0 ... 1
  double natural = 0.0;    ///< share without artificial positions
  double reached = 0.0;    ///< share with them
  std::uint64_t seed = 0;  ///< of their random choice
};

struct Scene {
  /// As given: "four-bar:40", "four-bar:40,fill=0.30", "pendulum.json"; UTF-8 without control
  /// characters, for in a path such bytes become \xNN.
  std::string name;
  Model model;
  std::optional<int> four_bar_loops;  ///< N, if the scene is the generated N-four-bar
  std::optional<Fill> fill;           ///< if artificial fill was asked for
};

inline constexpr int kMostLoops = 100'000;                ///< of four_bar(): n = 200 002
inline constexpr std::uint64_t kFillSeed = 607'615;       ///< of "four-bar:N,fill=F"
inline constexpr long kMostFilledPositions = 50'000'000;  ///< of a tangent, for add_fill()

/// Reads "four-bar:N", "four-bar:N,fill=F" or the path of a JSON scene (harness/scenes/README.md
/// has the format). Throws UsageError.
Scene load_scene(const std::string& text);

/// The N-loop four-bar mechanism of paper/README.md; points A0..AN (fixed), then B0..BN.
/// Throws UsageError unless 1 <= loops <= kMostLoops.
ModelData four_bar(int loops);

/// Parses the text of a JSON scene and checks it, physically too; `where` names it in errors.
/// A Model made from the result is valid. Throws UsageError.
ModelData parse_scene(std::string_view json, const std::string& where);

/// Number of non-zero positions of the tangent (5), both triangles: pattern of M plus Phi_q^T
/// Phi_q.
long tangent_nonzeros(const Model& model);

/// Adds stored zeros to data.mass, off the diagonal, chosen at random with `seed`, until the
/// tangent of the model holds `asked` * n^2 positions (to within one symmetric pair). Throws
/// UsageError if `asked` is outside (0, 1] or below the natural fill ("not reached"), or if the
/// tangent would hold more than kMostFilledPositions. The choice is uniform over all sets of absent
/// pairs and the same on every platform.
Fill add_fill(ModelData& data, double asked, std::uint64_t seed);

}  // namespace mbs
