// compiled_chains: describes it, makes its simulations, prints what it takes.
#include "mbs/implementation.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>

#include "kernels.hpp"
#include "topology.hpp"

namespace mbs::compiled_chains {
namespace {

constexpr Serves kServes = {.terms = {Term::mass_across_axes},
                            .saddle_point = true,
                            .rattle = true,
                            .multistep = true,
                            .projections_every = true};

/// Whether COMPILED_CHAINS_PRINT asks for a listing in this process, which has had none yet.
bool is_listing_due() {
  static bool printed = false;
  const char* asked = std::getenv("COMPILED_CHAINS_PRINT");
  if (printed || asked == nullptr || *asked == '\0') return false;
  return printed = true;
}

/// What a kernel goes through, for a model that is a chain: README.md, "Elimination".
void list_chain(std::ostream& out, const Model& model) {
  const auto chain = find_chain(model);
  const auto name = [&](int place) {
    const int offset = chain->places[place].coordinate;
    const auto has_it = [&](const Point& point) { return point.offset == offset; };
    return std::find_if(model.points().begin(), model.points().end(), has_it)->name;
  };
  const int count = static_cast<int>(chain->places.size()), last = count / 2;
  out << "compiled_chains/sweeps: points " << count << ", each a block of two rows; a sweep takes\n"
      << "from both ends at once one block in each of two lanes.\n";
  const auto print_end = [&](int first, int final) {
    out << ' ' << name(first) << (first == final ? "" : " ... " + name(final));
  };
  if (last > 0) {
    out << "lane 0:";
    print_end(0, last - 1);
    out << "\nlane 1:" << (count % 2 == 0 ? " (a block at rest)" : "");
    if (last + 1 < count) print_end(count - 1, last + 1);
    out << '\n';
  }
  out << "last: " << name(last) << ", where the lanes meet\nkernel: blocks of M "
      << (chain->isotropic ? "are multiples of I" : "are any")
      << "; distances to fixed points: " << chain->least_rods;
  if (chain->most_rods > chain->least_rods) out << '-' << chain->most_rods;
  out << " a point\n";
}

std::unique_ptr<Simulation> create_printing(const Model& model, const StepSettings& settings) {
  auto simulation = create(model, settings);
  if (is_listing_due()) list_chain(std::cerr, model);
  return simulation;
}

}  // namespace

Implementation implementation() {
  Variant sweeps;
  sweeps.name = "sweeps";
  sweeps.description = "kernels that eliminate a chain of points from both ends; no other scene";
  sweeps.create = create_printing;
  sweeps.serves = kServes;
  sweeps.refuses = why_no_chain;
  sweeps.create_batch = create_batch;
  sweeps.batch_lanes = batch_lanes();
  Implementation all;
  all.description = "chains of points alone: assembly, elimination and solve in the same sweeps";
  all.library = "none";
  all.variants = {sweeps};
  return all;
}

}  // namespace mbs::compiled_chains
