// A scene: what the user asked for, lowered to a Model.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// Artificial non-zeros in M (stored zeros) that raise the tangent's fill without changing physics.
struct Fill {
  double asked = 0.0;      ///< share of the tangent's n^2 positions, 0 ... 1
  double natural = 0.0;    ///< share without artificial positions
  double reached = 0.0;    ///< share with them
  std::uint64_t seed = 0;  ///< of their random choice
};

/// A point or unit vector of a body that is no coordinate: r = sum over `parts` of matrix *
/// r_point.
struct Marker {
  struct Part {
    int point = 0;  ///< index into Model::points()
    std::array<std::array<double, 3>, 3> matrix{};
  };
  std::string name;
  std::vector<Part> parts = {};
  bool is_vector = false;
};

/// From `from` to `to`, or a unit vector alone (`from` = -1); indices into Model::points().
struct Direction {
  int from = -1, to = -1;
};

/// One quantity that a run is asked for.
struct Output {
  enum class Kind {
    position,
    velocity,
    acceleration,  ///< of `point`
    angle,         ///< from `first` to `second`, about `axis` in 3D, rad
    distance,      ///< between first.from and first.to, m
    kinetic_energy,
    potential_energy,
    total_energy,      ///< J
    constraint_force,  ///< of the constraint whose rows are `rows`; `force` says what of it
  };
  enum class Force {
    tension,     ///< N: the pull of the ends of `first` on each other, by its distance and angles
    torque,      ///< of an angle, N m: on `second`, about z (3D: about first x second)
    vector,      ///< N: on the point first.to, which is held relative to first.from
    multiplier,  ///< `factor` times lambda
  };
  std::string name;
  Kind kind = Kind::position;
  int point = -1;  ///< index into Model::points(), or past its end into Elements::markers
  Direction first = {}, second = {};
  int axis = -1;  ///< index into Model::points()
  Force force = Force::tension;
  std::vector<int> rows = {};  ///< indices into Phi
  double factor = 1.0;
};

/// What the energy has beyond the Model's: M and Q end at driven points.
struct DrivenEnergy {
  /// Adds value * (velocity of a along axis_a) * (velocity of b along axis_b) to the kinetic
  /// energy.
  struct Mass {
    int a = 0, axis_a = 0, b = 0, axis_b = 0;  ///< driven points, indices into Model::points()
    double value = 0.0;                        ///< kg
  };
  /// A constant force on a driven point.
  struct Force {
    int point = 0;
    std::array<double, 3> force{};  ///< N
  };
  std::vector<Mass> masses;
  std::vector<Force> forces;
};

/// A function of time that the scene's author gave, and what a run may make of it.
struct Driver {
  std::string path;  ///< in the file: "constraints[0].value"
  std::string name;  ///< of its constraint, as messages have it; empty: that of a point
  TimeFunction value;
  double longest_step = std::numeric_limits<double>::infinity();  ///< s, that resolves it
  std::string resolution = {};  ///< what longest_step is: "a twentieth of its period"
  double least = -std::numeric_limits<double>::infinity();  ///< of its value during a run
  double most = std::numeric_limits<double>::infinity();
  double largest_change = std::numeric_limits<double>::infinity();  ///< in one step
  std::string range = {};  ///< what is allowed: "a distance above 0 m"
};

/// A value that a program sets from step to step, wherever the scene has {"input": ...} of this
/// name.
struct Input {
  std::string name;
  double start = 0.0;                         ///< what it is until then
  std::shared_ptr<TimeFunction::Sample> now;  ///< what the functions of the Model read
};

/// What the scene's author named, for outputs, messages and pictures; no implementation sees it.
struct Elements {
  struct Rod {
    std::string name;
    int a = 0, b = 0;
  };
  struct Body {
    std::string name;
    std::vector<int> points;   ///< indices into Model::points(), or past its end into `markers`
    std::vector<int> vectors;  ///< indices into Model::points()
  };
  std::vector<Rod> rods;
  std::vector<Rod> distances;  ///< constraints
  std::vector<Body> bodies;
  std::vector<Marker> markers;
  std::vector<int> helpers;  ///< points and vectors that the scene does not name; as in bodies
  std::vector<Output> outputs;
  std::vector<Driver> drivers = {};
  std::vector<Input> inputs = {};
  DrivenEnergy driven_energy;
  /// Springs whose stiffness is a function of time: indices into Model::force_laws().
  std::vector<std::size_t> driven_springs = {};
};

/// What the assembly of the start changed.
struct AssemblyReport {
  double position_correction = 0.0;  ///< largest change of a point given or a coordinate, m
  double velocity_correction = 0.0;  ///< m/s
  std::string point;                 ///< where the first of them is
};

struct Scene {
  /// As given: "four-bar:40", "four-bar:40,fill=0.30", "pendulum.json"; UTF-8 without control
  /// characters, for in a path such bytes become \xNN.
  std::string name;
  Model model;
  std::optional<int> four_bar_loops;  ///< N, if the scene is the generated N-four-bar
  std::optional<Fill> fill;           ///< if artificial fill was asked for
  Elements elements = {};
  AssemblyReport assembly = {};
};

/// What the file says of a point or vector of a body that is no coordinate.
struct GivenMarker {
  int marker = 0;    ///< index into Elements::markers
  std::string path;  ///< in the file: "points[1]"
  bool is_vector = false;
  std::optional<std::array<double, 3>> position, velocity;  ///< m, m/s
};

/// A scene on its way to a Model: assembled or not.
struct SceneData {
  ModelData model;
  Elements elements;
  std::vector<std::string> velocity_paths = {};  ///< what gave the velocity of each model point
  std::vector<GivenMarker> given_markers = {};
  double largest_correction = 0.0;  ///< m; allowed to the assembly
  AssemblyReport assembly = {};
};

inline constexpr int kMostLoops = 100'000;                ///< of four_bar(): n = 200 002
inline constexpr std::uint64_t kFillSeed = 607'615;       ///< of "four-bar:N,fill=F"
inline constexpr long kMostFilledPositions = 50'000'000;  ///< of a tangent, for add_fill()

/// The N-loop four-bar mechanism of paper/README.md; points A0..AN (fixed), then B0..BN.
/// Throws UsageError unless 1 <= loops <= kMostLoops.
ModelData four_bar(int loops);
/// Its rods, for pictures, and position and velocity of B0 as outputs.
Elements four_bar_elements(int loops);

/// Moves data.model's start onto its constraints: positions onto Phi(q, 0) = 0, then velocities
/// onto Phi_q v = -Phi_t, each by the smallest change in the norm of M (Gauss-Newton; redundant
/// constraints are fine). Velocities given, that is not zero, stay as they are if the others can
/// follow, and change a millionth as easily as those if not. A start on its constraints to rounding
/// is left bit for bit. What the file gives of points that are no coordinates counts like theirs.
/// Fills data.assembly. Throws NotAssembled, prefixed by `where`, naming the constraint and by how
/// much it fails, if that does not converge, if a point would move by more than
/// data.largest_correction (a unit vector: by more than its share of the scene's extent), or if a
/// given velocity would change by more than a tenth of the largest given.
void assemble_start(SceneData& data, const std::string& where);

/// Number of non-zero positions of the tangent (5), both triangles: pattern of M, C, K and Phi_q^T
/// Phi_q.
long tangent_nonzeros(const Model& model);

/// Adds stored zeros to data.mass, off the diagonal, chosen at random with `seed`, until the
/// tangent of the model holds `asked` * n^2 positions (to within one symmetric pair). Throws
/// UsageError if `asked` is outside (0, 1] or below the natural fill ("not reached"), or if the
/// tangent would hold more than kMostFilledPositions. The choice is uniform over all sets of absent
/// pairs and the same on every platform.
Fill add_fill(ModelData& data, double asked, std::uint64_t seed);

}  // namespace mbs
