// Describes the dense Eigen implementation and makes its simulations.
#include "mbs/implementation.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <string>

#include "lu_solver.hpp"
#include "multistep.hpp"
#include "newton.hpp"
#include "penalty_system.hpp"
#include "rattle.hpp"
#include "rounded.hpp"
#include "saddle_lu.hpp"
#include "saddle_solver.hpp"
#include "saddle_system.hpp"
#include "simulation.hpp"
#include "solver.hpp"

namespace mbs::eigen_dense {

namespace {

constexpr Terms kTerms{
    Term::dots,    Term::bilinear, Term::linear,     Term::springs, Term::torsion_springs,
    Term::dampers, Term::couples,  Term::force_laws, Term::drivers, Term::mass_across_axes,
    Term::spatial};

/// No matrix larger than this is stored; there are three or four of them.
constexpr double kMatrixLimit = 2.0 * 1024 * 1024 * 1024;  // bytes

void require_size(const Model& model, const StepSettings& settings) {
  const bool whole = settings.scheme == Scheme::saddle_point &&
                     (settings.geometric_stiffness || settings.precision == Precision::mixed);
  const double n = model.variables(), m = model.constraints();
  const double columns = whole ? n + m : std::max(n, m);  // `whole` is SaddleLu's
  const double rows = settings.scheme == Scheme::penalty ? n : columns;
  if (sizeof(double) * columns * rows <= kMatrixLimit) return;
  throw Unsupported("a dense matrix of " + std::to_string(model.variables()) +
                    " variables would exceed 2 GiB");
}

bool is_trapezoidal(Scheme scheme) {
  return scheme == Scheme::penalty || scheme == Scheme::saddle_point;
}

/// Whether Simulation, which is the step without any choices, does.
bool is_plain(const StepSettings& settings) {
  return settings.scheme == Scheme::penalty &&
         settings.multipliers == MultiplierUpdate::every_pass &&
         settings.tangent == TangentReuse::none && settings.projections_every == 1 &&
         settings.precision == Precision::double_precision && !settings.geometric_stiffness;
}

/// `Penalty` and `Saddle` are the linear systems that go with the precision.
template <typename Penalty, typename Saddle>
std::unique_ptr<mbs::Simulation> create_newton(const Model& model, const StepSettings& settings) {
  if (settings.scheme == Scheme::penalty) return std::make_unique<Newton<Penalty>>(model, settings);
  return std::make_unique<Newton<Saddle>>(model, settings);
}

template <typename Scalar>
std::unique_ptr<mbs::Simulation> create_in(const Model& model, const StepSettings& settings) {
  if (!is_trapezoidal(settings.scheme)) return std::make_unique<Rattle<Scalar>>(model, settings);
  using Penalty = PenaltySystem<Scalar, Solver<Scalar>>;
  using Saddle = SaddleSystem<Scalar, SaddleSolver<Scalar>>;
  using ExactPenalty = ExactPenaltySystem<Scalar, LuSolver<Scalar>>;
  using ExactSaddle = ExactSaddleSystem<Scalar, SaddleLu<Scalar>>;
  return settings.geometric_stiffness ? create_newton<ExactPenalty, ExactSaddle>(model, settings)
                                      : create_newton<Penalty, Saddle>(model, settings);
}

std::unique_ptr<mbs::Simulation> create_mixed(const Model& model, const StepSettings& settings) {
  using Penalty = PenaltySystem<double, Rounded<Solver<float>>>;
  using Saddle = SaddleSystem<double, Rounded<SaddleLu<float>>>;
  using ExactPenalty = ExactPenaltySystem<double, Rounded<LuSolver<float>>>;
  using ExactSaddle = ExactSaddleSystem<double, Rounded<SaddleLu<float>>>;
  return settings.geometric_stiffness ? create_newton<ExactPenalty, ExactSaddle>(model, settings)
                                      : create_newton<Penalty, Saddle>(model, settings);
}

std::unique_ptr<mbs::Simulation> create(const Model& model, const StepSettings& settings) {
  require_size(model, settings);
  if (settings.scheme == Scheme::multistep6) return std::make_unique<Multistep>(model, settings);
  if (is_plain(settings)) return std::make_unique<Simulation>(model, settings);
  if (settings.precision == Precision::single_precision) return create_in<float>(model, settings);
  if (settings.precision == Precision::mixed) return create_mixed(model, settings);
  return create_in<double>(model, settings);
}

std::unique_ptr<mbs::Simulation> create_blocks(const Model& model, const StepSettings& settings) {
  constexpr Eigen::Index kOwnLimit = 32;  // Eigen's
  require_size(model, settings);
  return std::make_unique<Simulation>(model, settings, kOwnLimit);
}

std::string eigen_version() {
  return std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
         std::to_string(EIGEN_MINOR_VERSION);
}

}  // namespace

Implementation implementation() {
  Implementation description;
  description.description = "dense column-major storage, rank-k update, Cholesky (LLT)";
  description.library = "Eigen";
  description.version = eigen_version();
  description.licence = "MPL-2.0";
  description.variants = {{.name = "llt",
                           .description = "Cholesky in place on the lower triangle",
                           .create = create,
                           .dense = true,
                           .serves = {.terms = kTerms,
                                      .saddle_point = true,
                                      .rattle = true,
                                      .multistep = true,
                                      .multiplier_update = true,
                                      .tangent_reuse = true,
                                      .projections_every = true,
                                      .single_precision = true,
                                      .mixed_precision = true,
                                      .geometric_stiffness = true}},
                          {.name = "llt_blocks",
                           .description = "blocks from 33 variables on, as in Eigen's LLT",
                           .create = create_blocks,
                           .dense = true,
                           .serves = {.terms = kTerms},
                           .tried_for = "llt"}};
  description.role = Role::paper;
  return description;
}

}  // namespace mbs::eigen_dense
