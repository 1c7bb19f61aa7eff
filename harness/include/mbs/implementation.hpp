// How an implementation describes itself to the harness.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mbs/batch.hpp"
#include "mbs/operations.hpp"
#include "mbs/simulation.hpp"
#include "mbs/terms.hpp"

namespace mbs {

/// Which terms a model may have for a variant, and which settings beyond the defaults of
/// StepSettings it honours, alone and in every combination that paper/other_schemes.md, "Which
/// settings go together", allows. The harness refuses all else by name, so that no implementation
/// has to. The default is what the paper's maps need.
struct Serves {
  Terms terms = {};                  ///< beyond planar distances, constant M and gravity
  bool saddle_point = false;         ///< Scheme::saddle_point
  bool rattle = false;               ///< Scheme::rattle, rattle4 and rattle6
  bool multistep = false;            ///< Scheme::multistep6
  bool multiplier_update = false;    ///< MultiplierUpdate::converged
  bool tangent_reuse = false;        ///< TangentReuse::step and kept
  bool projections_every = false;    ///< more than 1
  bool single_precision = false;     ///< Precision::single_precision
  bool mixed_precision = false;      ///< Precision::mixed
  bool geometric_stiffness = false;  ///< StepSettings::geometric_stiffness
};

/// One way of running an implementation, named "folder/name". It needs a name, a description and
/// create(); all else has its default.
struct Variant {
  std::string name;         ///< lower case, for instance "refactor"
  std::string description;  ///< one line
  /// Sets a simulation up (timed apart from stepping). `model` outlives the simulation.
  /// Throws Unsupported if this implementation cannot simulate `model`.
  std::unique_ptr<Simulation> (*create)(const Model& model, const StepSettings& settings) = nullptr;
  /// Why step() allocates memory, where the library leaves no choice; empty: it must not.
  std::string allocates = "";
  bool dense = false;  ///< stores and factorizes all n^2 positions of the tangent
  /// Its solver takes unsymmetric matrices too, which other formulations than this one give.
  bool unsymmetric = false;
  Serves serves = {};
  /// Why create() throws Unsupported for `model`, whose terms it serves, without setting anything
  /// up; empty if it does not. nullptr: it takes all. Asked where somebody is to be named for a scene.
  std::string (*refuses)(const Model& model) = nullptr;
  /// The operations of Table 2 alone, as this variant's step does them; nullptr: not offered.
  std::unique_ptr<Operations> (*operations)(const Model& model) = nullptr;
  /// Many at once, for `mbs sweep`; nullptr: they run one after the other, as they do where this
  /// throws Unsupported. The models outlive the batch.
  std::unique_ptr<BatchSimulation> (*create_batch)(
      std::span<const Model* const> models, std::span<const StepSettings> settings) = nullptr;
  int batch_lanes = 0;  ///< with create_batch: the number of lanes that it is best given
  bool own_code = false;  ///< stands on no library, though others of its folder do
  /// The variant of this folder that this one is, with a setting that was tried and not taken:
  /// listed, and timed and gated only where it is named in full. Empty: it stands for itself.
  std::string tried_for = "";
};

/// What an implementation is for.
enum class Role {
  contender,  ///< takes part in all comparisons
  paper,      ///< as a contender; variants of it, named in analysis/map/paper.py, stand for the paper's
  example,    ///< to be read: gated and listed, timed only where it is named
};

/// What the folder `implementations/<folder>/` offers. The folder defines
///
///   namespace mbs::<folder> { Implementation implementation(); }
///
/// and its line in implementations/CMakeLists.txt puts it into the registry.
struct Implementation {
  std::string description;  ///< one line: storage, algorithm
  std::string library;      ///< for instance "KLU"; without one "none"
  std::string version;      ///< as the library itself reports it, for instance "1.3.9"; else empty
  std::string licence;      ///< of the library, SPDX, "LGPL-2.1-or-later" for instance; else empty
  std::vector<Variant> variants;
  Role role = Role::contender;
};

}  // namespace mbs
