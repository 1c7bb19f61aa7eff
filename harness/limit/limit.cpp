// The hand-written chain as a Simulation, and which models it is for.
#include "limit/limit.hpp"

#include <algorithm>
#include <cmath>

#include "limit/chain_state.hpp"
#include "scene/scene.hpp"

namespace mbs::limit {

template class Chain<Pair>;

namespace {

bool equal(double a, double b) { return std::abs(a - b) <= 1e-14 * std::abs(b); }

bool equal(const Point& a, const Point& b) {
  const bool same_place = !b.is_fixed() || a.position == b.position;
  return a.offset == b.offset && same_place;
}

bool equal(const DotConstraint& a, const DotConstraint& b) {
  const auto joins = [&](int first, int second) {
    return a.a == first && a.b == second && a.c == first && a.d == second;
  };
  return (joins(b.a, b.b) || joins(b.b, b.a)) && a.value == b.value;
}

bool equal(const MassEntry& a, const MassEntry& b) {
  return a.row == b.row && a.col == b.col && equal(a.value, b.value);
}

template <class Items>
bool all_equal(const Items& a, const Items& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& x, const auto& y) { return equal(x, y); });
}

/// Whether the equations of both are the same, whatever their names and starts. The factory has
/// refused all but planar distances, masses and constant forces.
bool same_mechanism(const Model& model, const Model& other) {
  return all_equal(model.points(), other.points()) &&
         all_equal(model.dot_constraints(), other.dot_constraints()) &&
         all_equal(model.mass(), other.mass()) && all_equal(model.force(), other.force());
}

/// N of the N-four-bar. Throws Unsupported if the model is anything else.
int loops_of(const Model& model) {
  const int loops = (model.variables() - 2) / 2;
  if (loops < 1 || loops > kMostLoops || model.variables() != 2 * loops + 2 ||
      !same_mechanism(model, Model(four_bar(loops)))) {
    throw Unsupported("it is written for the N-four-bar mechanism alone");
  }
  return loops;
}

class LimitSimulation final : public Simulation {
 public:
  LimitSimulation(const Model& model, const StepSettings& settings)
      : Simulation(model, settings), chain_(loops_of(model), settings) {
    if (settings.projections != Projections::both) {
      throw Unsupported("it is written for both projections");
    }
  }

 protected:
  void do_set_state(const State& state) override { chain_.set_state(state); }
  StepOutcome do_step() override { return chain_.step(); }
  void do_get_state(State& state) const override { chain_.get_state(state); }

 private:
  Chain<Pair> chain_;
};

}  // namespace

const Variant& variant() {
  static const Variant result{
      .name = "limit",
      .description = "written by hand for the N-four-bar",
      .create = [](const Model& model,
                   const StepSettings& settings) -> std::unique_ptr<Simulation> {
        return std::make_unique<LimitSimulation>(model, settings);
      }};
  return result;
}

}  // namespace mbs::limit
