// Instantiates the chain for numbers that count.
#include "limit/count.hpp"

#include "limit/chain_state.hpp"

namespace mbs::limit {

template class Chain<Counted>;

namespace {

/// When the last number of the state is there, ns.
double last_ready(std::span<const Block<Counted>> blocks) {
  double last = 0.0;
  for (const Block<Counted>& b : blocks) {
    for (const Counted* number : {&b.x, &b.y, &b.ux, &b.uy, &b.wx, &b.wy, &b.rod, &b.coupler}) {
      last = std::max(last, number->ready);
    }
  }
  return last;
}

}  // namespace

Count count_steps(int loops, const StepSettings& settings, const State& initial, long steps,
                  const Latencies& latencies) {
  Counted::latencies = latencies;
  Chain<Counted> chain(loops, settings);
  chain.set_state(initial);
  Counted::operations = {};
  Count count;
  for (; count.steps < steps; ++count.steps) count.passes += chain.step().passes;
  count.operations = Counted::operations;
  count.critical_path = last_ready(chain.blocks());
  count.bytes = chain.blocks().size() * (sizeof(Block<Pair>) + sizeof(Factor<Pair>));
  return count;
}

}  // namespace mbs::limit
