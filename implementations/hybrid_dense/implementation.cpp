// What this folder offers: one sparse evaluation and assembly, three dense factorizations.
#include "mbs/implementation.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "simulation.hpp"

namespace mbs::hybrid_dense {
namespace {

/// No matrix larger than this is stored; there are two or more of them.
constexpr double kMatrixLimit = 2.0 * 1024 * 1024 * 1024;  // bytes

void require_size(const Model& model, const StepSettings& settings) {
  const double n = model.variables(), m = model.constraints();
  const double rows = settings.scheme == Scheme::saddle_point ? std::max(n, m) : n;
  if (sizeof(double) * rows * rows <= kMatrixLimit) return;
  throw Unsupported("a dense matrix of " + std::to_string(static_cast<int>(rows)) +
                    " rows would exceed 2 GiB");
}

template <int D, class Solver>
std::unique_ptr<Simulation> create_in(const Model& model, const StepSettings& settings) {
  if (settings.scheme == Scheme::saddle_point) {
    return std::make_unique<HybridSimulation<D, SaddleSystem<D, Solver>>>(model, settings);
  }
  return std::make_unique<HybridSimulation<D, PenaltySystem<D, Solver>>>(model, settings);
}

template <class Solver>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  require_size(model, settings);
  return model.dimension() == 2 ? create_in<2, Solver>(model, settings)
                                : create_in<3, Solver>(model, settings);
}

/// Eigen's blocks, penalty form.
std::unique_ptr<Simulation> create_blocks(const Model& model, const StepSettings& settings) {
  require_size(model, settings);
  if (model.dimension() == 2) {
    return std::make_unique<HybridSimulation<2, PenaltySystem<2, LltBlocksSolver>>>(model, settings);
  }
  return std::make_unique<HybridSimulation<3, PenaltySystem<3, LltBlocksSolver>>>(model, settings);
}

template <class Solver>
Variant variant(const char* name, const char* description) {
  return {
      .name = name,
      .description = description,
      .create = create<Solver>,
      .dense = true,
      .serves = {.terms = {Term::dots, Term::bilinear, Term::linear, Term::springs,
                           Term::torsion_springs, Term::dampers, Term::couples, Term::force_laws,
                           Term::drivers, Term::mass_across_axes, Term::spatial},
                 .saddle_point = true}};
}

}  // namespace

Implementation implementation() {
  Variant panels = variant<PanelsSolver>("panels", "own kernels in panel-major storage");
  panels.own_code = true;
  Variant blocks = variant<LltSolver>("llt_blocks", "Eigen's kernels and block sizes");
  blocks.create = create_blocks;
  blocks.serves.saddle_point = false;
  blocks.tried_for = "llt";
  return {.description = "sparse evaluation and scheduled assembly, dense Cholesky",
          .library = "Eigen, LAPACK",
          .version = library_versions(),
          .licence = "MPL-2.0, BSD-3-Clause",
          .variants = {variant<LltSolver>("llt", "Eigen's kernels, own block sizes"),
                       variant<PotrfSolver>("potrf", "LAPACK's dpotrf and dpotrs"),
                       std::move(panels), std::move(blocks)}};
}

}  // namespace mbs::hybrid_dense
