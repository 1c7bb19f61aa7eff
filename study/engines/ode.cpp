// Open Dynamics Engine: free rigid bodies, joined by hinges; loops closed by hinges or ball joints.
#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>

#include "engine.hpp"

namespace engines {
namespace {

class OdeEngine final : public FixedStepEngine {
 public:
  OdeEngine(const Mechanism& mechanism, Settings& settings)
      : FixedStepEngine(settings), mechanism_(mechanism), world_(dWorldCreate()) {
    dWorldSetGravity(world_, 0, -kGravity, 0);
    // ODE's own values for double precision.
    dWorldSetERP(world_, settings.number("erp", 0.2));
    dWorldSetCFM(world_, settings.number("cfm", 1e-10));
    quick_ = settings.choice("method", {"step", "quickstep"}) == 1;
    if (quick_) {
      dWorldSetQuickStepNumIterations(world_,
                                      static_cast<int>(settings.positive("iterations", 20)));
    }
    finite_rotation_ = settings.choice("rotation", {"infinitesimal", "finite"}) == 1;
    planar_ = settings.choice("plane", {"free", "plane2d"}) == 1;
    const auto states = initial_states(mechanism);
    for (std::size_t i = 0; i < states.size(); ++i) add(mechanism.rods[i], states[i]);
    for (std::size_t i = 0; i < states.size(); ++i) pin(i, states[i]);
    const auto closure = settings.choice("closure", {"ball", "hinge"});
    for (const Loop& loop : mechanism.loops) close(loop, states, closure == 1);
  }
  ~OdeEngine() override { dWorldDestroy(world_); }
  OdeEngine(const OdeEngine&) = delete;
  OdeEngine& operator=(const OdeEngine&) = delete;

  void read(std::vector<RodState>& states) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const dReal *p = dBodyGetPosition(bodies_[i]), *v = dBodyGetLinearVel(bodies_[i]);
      const dReal* r = dBodyGetRotation(bodies_[i]);  // rows of 4
      states[i] = {p[0], p[1], r[0], r[4], v[0], v[1], dBodyGetAngularVel(bodies_[i])[2]};
    }
  }

 protected:
  void do_step() override {
    const int done = quick_ ? dWorldQuickStep(world_, step()) : dWorldStep(world_, step());
    if (done == 0) throw std::runtime_error("ODE could not allocate memory for a step");
  }

 private:
  void add(const Rod& rod, const RodState& state) {
    const dBodyID body = dBodyCreate(world_);
    dMass mass;
    dMassSetParameters(&mass, rod.mass, 0, 0, 0, rod.inertia(), rod.inertia(), rod.inertia(), 0, 0,
                       0);
    dBodySetMass(body, &mass);
    dMatrix3 rotation;
    dRFromAxisAndAngle(rotation, 0, 0, 1, rod.angle);
    dBodySetRotation(body, rotation);
    dBodySetPosition(body, state.x, state.y, 0);
    dBodySetLinearVel(body, state.vx, state.vy, 0);
    dBodySetAngularVel(body, 0, 0, state.rate);
    dBodySetGyroscopicMode(body, 0);  // equal moments have none
    dBodySetFiniteRotationMode(body, finite_rotation_ ? 1 : 0);
    if (planar_) dJointAttach(dJointCreatePlane2D(world_, nullptr), body, nullptr);
    bodies_.push_back(body);
  }

  /// The pin of rod `i`. A body that is kept in the plane needs no hinge: a ball joint's rows are
  /// fewer.
  void pin(std::size_t i, const RodState& state) {
    const Rod& rod = mechanism_.rods[i];
    const dBodyID up = rod.parent < 0 ? nullptr : bodies_[static_cast<std::size_t>(rod.parent)];
    const double half = rod.length / 2;
    join(!planar_, bodies_[i], up, state.x - half * state.cosine, state.y - half * state.sine);
  }

  /// Hinges close a planar loop with three rows too many, ball joints with one.
  void close(const Loop& loop, const std::vector<RodState>& states, bool by_hinge) {
    const auto i = static_cast<std::size_t>(loop.rod);
    const double half = mechanism_.rods[i].length / 2;
    join(by_hinge, bodies_[i], bodies_[static_cast<std::size_t>(loop.other)],
         states[i].x + half * states[i].cosine, states[i].y + half * states[i].sine);
  }

  void join(bool by_hinge, dBodyID first, dBodyID second, double x, double y) {
    const dJointID joint =
        by_hinge ? dJointCreateHinge(world_, nullptr) : dJointCreateBall(world_, nullptr);
    dJointAttach(joint, first, second);
    if (by_hinge) {
      dJointSetHingeAnchor(joint, x, y, 0);
      dJointSetHingeAxis(joint, 0, 0, 1);
    } else {
      dJointSetBallAnchor(joint, x, y, 0);
    }
  }

  const Mechanism mechanism_;
  dWorldID world_;
  bool quick_ = false, finite_rotation_ = false, planar_ = false;
  std::vector<dBodyID> bodies_;
};

void complain(int, const char* format, va_list values) {
  char buffer[300];
  std::vsnprintf(buffer, sizeof buffer, format, values);
  note_complaint(buffer);
}

std::unique_ptr<Engine> create(const Mechanism& mechanism, Settings& settings, double) {
  dInitODE2(0);
  dSetMessageHandler(complain);
  return std::make_unique<OdeEngine>(mechanism, settings);
}

}  // namespace
}  // namespace engines

int main(int argc, char** argv) {
  return engines::run_program({"ode", ENGINE_VERSION, engines::create}, argc, argv);
}
