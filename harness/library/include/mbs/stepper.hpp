// The library: a scene, stepped from one's own program. harness/library/README.md begins with an
// example.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

/// What the library refuses: a scene, a name, a number, a setting. what() is one line: what was
/// found and what is allowed. A call that throws it has changed nothing.
class Refused : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A scene that is read and may still be changed. Copies share nothing.
class SceneDocument {
 public:
  /// What `mbs simulate` takes: the path of a JSON file, "four-bar:40", "vehicle:4". Throws
  /// Refused.
  static SceneDocument load(const std::string& scene);
  /// The text of a JSON scene; `name` stands for it in messages. Throws Refused where it is no
  /// JSON object. What a scene must have, Stepper and describe() look at: numbers may still change.
  static SceneDocument parse(std::string_view json, const std::string& name = "scene");

  SceneDocument(const SceneDocument& other);
  SceneDocument& operator=(const SceneDocument& other);
  ~SceneDocument();

  /// A number of the document, by the path that `mbs sweep --vary` takes:
  /// "springs/front/stiffness", "points/B/velocity/0". Throws Refused with what is there.
  [[nodiscard]] double number(const std::string& path) const;
  void set_number(const std::string& path, double value);  ///< finite

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] std::string json() const;
  /// What `mbs describe --json` prints for a time step of `step` s. Throws Refused.
  [[nodiscard]] std::string describe(double step = StepSettings{}.step) const;

 private:
  friend class Stepper;
  friend class BatchStepper;
  struct Content;
  explicit SceneDocument(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

/// How a scene is stepped.
struct StepperOptions {
  /// "folder/variant" of implementations(), or "auto": of those in this build, the one that the
  /// measured rule of `mbs describe` expects to be fastest on the scene; where the scheme is
  /// the penalty form and its factor is left to choose, in the form that suits the scene.
  std::string implementation = "auto";
  /// A penalty or tolerance of 0 is chosen from the scene, as `mbs simulate` does.
  StepSettings settings = {};
};

/// An implementation of this build, and the library that it stands on.
struct Offer {
  std::string name;         ///< "folder/variant"
  std::string description;  ///< one line
  std::string library;      ///< "none": code of this project alone, under its licence
  std::string licence;      ///< of that library, SPDX
  std::string allocates;    ///< why its step() allocates memory; empty: it does not
};
std::vector<Offer> implementations();

/// "0.1.0".
const char* version();

/// A moment of a Stepper, to come back to. It belongs to the scene and the settings: any Stepper of
/// an equal document and equal settings takes it. To begin a changed scene from it, save() there
/// and replace `state`.
struct Saved {
  State state;
  std::vector<TimeFunction::Sample> inputs;
  std::vector<double> angles;  ///< as outputs count them, with turns
  std::uint64_t identity = 0;  ///< of the scene and settings
};

/// One simulation of one scene, from its start on. Set up once; step() and set_input() allocate
/// nothing (step() only where Offer::allocates says so), and neither do the others after their
/// first call, but outputs() of a scene with springs or laws that asks for its energy.
///
///   mbs::Stepper car(mbs::SceneDocument::load("car.json"));
///   const int road = car.input("road"), hub = car.output("hub.y");
///   for (;;) {
///     car.set_input(road, z, dz, ddz);  // at the end of the step
///     if (car.step().status != mbs::StepStatus::converged) break;
///     use(car.outputs()[hub]);
///   }
///
/// A Stepper belongs to one thread at a time; several of the same document share nothing.
class Stepper {
 public:
  /// Throws Refused, or Unsupported if the implementation does not serve the scene or the settings.
  explicit Stepper(const SceneDocument& scene, const StepperOptions& options = {});
  Stepper(Stepper&&) noexcept;
  Stepper& operator=(Stepper&&) noexcept;
  ~Stepper();

  /// The one chosen. "auto" chooses the form of the step, too: who names the same again needs the
  /// same settings().scheme.
  [[nodiscard]] const std::string& implementation() const;
  [[nodiscard]] const StepSettings& settings() const;  ///< with the chosen numbers

  /// Names of the scene's {"input": ...}, and columns of its "outputs" ("hub.x", "hub.y").
  [[nodiscard]] std::span<const std::string> input_names() const;
  [[nodiscard]] std::span<const std::string> output_names() const;
  /// Where a name is among them. Throws Refused with the names.
  [[nodiscard]] int input(std::string_view name) const;
  [[nodiscard]] int output(std::string_view name) const;

  /// What an input is from the next step on; of a function of time: its value at the end of that
  /// step. Forces, torques, stiffnesses, dampings and factors need the value alone. Over the step a
  /// force goes straight from its last value to the new one, so that a command acts half a step
  /// late. What moves a point or a constraint (m, rad) needs its rate (per s) and acceleration (per
  /// s^2) too, consistent with each other, anew for each step: both are kept. Throws Refused with
  /// the names if there is no such input, and where a scene file would: not a finite number, a
  /// negative stiffness or damping, a distance that is not above 0.
  void set_input(int input, double value, double rate = 0.0, double acceleration = 0.0);

  /// Delta t further.
  [[nodiscard]] StepOutcome step();
  /// At most `steps` steps, fewer where a factorization fails. The status is the worst of them,
  /// passes and factorizations are sums. Throws Refused if `steps` is below 1.
  [[nodiscard]] StepOutcome step(long steps);
  template <std::floating_point Number>
  StepOutcome step(Number steps) = delete;  ///< a time is no number of steps

  /// q, v, a, lambda and t now; valid until the next step or restore(). The same buffers every
  /// time.
  [[nodiscard]] const State& state();
  /// One number an output; valid like state(). Driven points are where the inputs are now. Angles
  /// count turns, provided that a step is less than half a turn.
  [[nodiscard]] std::span<const double> outputs();

  /// State and inputs. Kept tangents and the history of multistep6 begin anew with restore().
  void save(Saved& moment);
  /// Throws Refused if `moment` is of another scene or other settings, if its state is not finite,
  /// or if set_input() would refuse one of its inputs.
  void restore(const Saved& moment);

 private:
  friend class BatchStepper;
  struct Content;
  std::unique_ptr<Content> content_;
};

/// Several scenes of one shape at once: what `mbs sweep` does, for one's own loop. Where the
/// implementation offers no batch or the scenes differ in shape, they are stepped one after the
/// other.
class BatchStepper {
 public:
  /// Throws as Stepper, and Refused if there is no scene. `auto` is the choice for the first scene.
  explicit BatchStepper(std::span<const SceneDocument> scenes, const StepperOptions& options = {});
  BatchStepper(BatchStepper&&) noexcept;
  BatchStepper& operator=(BatchStepper&&) noexcept;
  ~BatchStepper();

  [[nodiscard]] int lanes() const;
  [[nodiscard]] bool is_side_by_side() const;
  [[nodiscard]] const std::string& implementation() const;
  [[nodiscard]] const StepSettings& settings(int lane) const;
  [[nodiscard]] std::span<const std::string> input_names() const;
  [[nodiscard]] std::span<const std::string> output_names() const;
  [[nodiscard]] int input(std::string_view name) const;
  [[nodiscard]] int output(std::string_view name) const;

  /// A lane counts from 0; Refused is thrown for any other. Inputs and outcomes as a Stepper's.
  void set_input(int lane, int input, double value, double rate = 0.0, double acceleration = 0.0);
  template <std::floating_point Number>
  void set_input(int lane, Number value, double = 0.0, double = 0.0) = delete;  ///< of which input?
  /// All lanes Delta t further; one outcome a lane. A lane that failed goes no further: its state
  /// and outputs are Refused.
  [[nodiscard]] std::span<const StepOutcome> step();
  [[nodiscard]] double t() const;  ///< s, of the lanes that have not failed
  [[nodiscard]] const State& state(int lane);
  [[nodiscard]] std::span<const double> outputs(int lane);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace mbs
