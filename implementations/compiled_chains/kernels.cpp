// Which kernel serves a chain with some settings.
#include "kernels.hpp"

#include <utility>
#include <vector>

#include "kinds.hpp"

namespace mbs::compiled_chains {

namespace {

constexpr const char* kNoChain =
    "the scene is not a chain of free points (masses and distances between neighbours, at most two "
    "distances from a point to fixed ones): use compiled_ldl/fronts";

Topology topology_of(const Model& model) {
  if (auto chain = find_chain(model)) return *std::move(chain);
  throw Unsupported(kNoChain);
}

}  // namespace

std::string why_no_chain(const Model& model) { return find_chain(model) ? "" : kNoChain; }

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  Topology topology = topology_of(model);
  switch (settings.scheme) {
    case Scheme::penalty:
      return create_penalty(model, settings, std::move(topology));
    case Scheme::saddle_point:
      return create_saddle_point(model, settings, std::move(topology));
    case Scheme::multistep6:
      return create_multistep(model, settings, std::move(topology));
    case Scheme::rattle:
    case Scheme::rattle4:
    case Scheme::rattle6:
      return create_rattle(model, settings, std::move(topology));
  }
  return nullptr;
}

std::unique_ptr<BatchSimulation> create_batch(std::span<const Model* const> models,
                                              std::span<const StepSettings> settings) {
  std::vector<Topology> chains;
  for (const Model* model : models) chains.push_back(topology_of(*model));
  switch (settings.front().scheme) {
    case Scheme::saddle_point:
      throw Unsupported("batches are not for the saddle-point form");
    case Scheme::multistep6:
      throw Unsupported("batches are not for the multistep method");
    case Scheme::penalty:
      return create_penalty_batch(models, settings, std::move(chains));
    case Scheme::rattle:
    case Scheme::rattle4:
    case Scheme::rattle6:
      return create_rattle_batch(models, settings, std::move(chains));
  }
  return nullptr;
}

int batch_lanes() { return 2 * Lanes<Wide>::kChains; }

}  // namespace mbs::compiled_chains
