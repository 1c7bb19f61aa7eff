// Bullet's btRigidBody: rods that move in the plane only, pinned by constraints in maximal
// coordinates.
#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>

#include "bullet.hpp"

namespace engines {
namespace {

class BodiesEngine final : public FixedStepEngine {
 public:
  BodiesEngine(const Mechanism& mechanism, Settings& settings)
      : FixedStepEngine(settings),
        mechanism_(mechanism),
        dispatcher_(&configuration_),
        shape_(0.01) {
    const std::vector<std::string> solvers{"si", "nncg", "dantzig", "lemke", "pgs"};
    const std::string solver = solvers[settings.choice("solver", solvers)];
    mlcp_ = create_mlcp(solver);
    if (mlcp_) {
      solver_ = std::make_unique<btMLCPSolver>(mlcp_.get());
    } else if (solver == "nncg") {
      solver_ = std::make_unique<btNNCGConstraintSolver>();
    } else {
      solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
    }
    world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(),
                                                       &configuration_);
    world_->setGravity(btVector3(0, -kGravity, 0));
    world_->getSimulationIslandManager()->setSplitIslands(false);  // one mechanism is one island
    apply(settings, world_->getSolverInfo());
    joint_ = settings.choice("joint", {"point", "hinge"});
    const auto states = initial_states(mechanism);
    for (std::size_t i = 0; i < states.size(); ++i) add(mechanism.rods[i], states[i]);
    for (std::size_t i = 0; i < states.size(); ++i) pin(static_cast<int>(i));
    for (const Loop& loop : mechanism.loops) join(loop.rod, +1, loop.other);
  }
  ~BodiesEngine() override {
    for (const auto& constraint : constraints_) world_->removeConstraint(constraint.get());
    for (const auto& body : bodies_) world_->removeRigidBody(body.get());
  }
  BodiesEngine(const BodiesEngine&) = delete;
  BodiesEngine& operator=(const BodiesEngine&) = delete;

  void read(std::vector<RodState>& states) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const btTransform& place = bodies_[i]->getWorldTransform();
      const btVector3 &p = place.getOrigin(), &v = bodies_[i]->getLinearVelocity();
      states[i] = {p.x(),
                   p.y(),
                   place.getBasis()[0][0],
                   place.getBasis()[1][0],
                   v.x(),
                   v.y(),
                   bodies_[i]->getAngularVelocity().z()};
    }
  }

 protected:
  void do_step() override { world_->stepSimulation(step(), 0); }

 private:
  void add(const Rod& rod, const RodState& state) {
    const btScalar moment = rod.inertia();
    auto body = std::make_unique<btRigidBody>(rod.mass, nullptr, &shape_,
                                              btVector3(moment, moment, moment));
    body->setWorldTransform(
        btTransform(btQuaternion(btVector3(0, 0, 1), rod.angle), btVector3(state.x, state.y, 0)));
    body->setLinearVelocity(btVector3(state.vx, state.vy, 0));
    body->setAngularVelocity(btVector3(0, 0, state.rate));
    body->setLinearFactor(btVector3(1, 1, 0));
    body->setAngularFactor(btVector3(0, 0, 1));
    body->setDamping(0, 0);
    body->setActivationState(DISABLE_DEACTIVATION);
    body->updateInertiaTensor();
    world_->addRigidBody(body.get(), 1, 0);  // collides with nothing
    bodies_.push_back(std::move(body));
  }

  void pin(int i) {
    const Rod& rod = mechanism_.rods[static_cast<std::size_t>(i)];
    if (rod.parent >= 0) return join(i, -1, rod.parent);
    btRigidBody& body = *bodies_[static_cast<std::size_t>(i)];
    const btVector3 local(-rod.length / 2, 0, 0);
    if (joint_ == 0) {
      keep(std::make_unique<btPoint2PointConstraint>(body, local));
    } else {
      keep(std::make_unique<btHingeConstraint>(body, local, btVector3(0, 0, 1)));
    }
  }

  /// Joins a side of rod `i` (-1 its pin, +1 its end) to the end of the `other`.
  void join(int i, int side, int other) {
    const auto first = static_cast<std::size_t>(i), second = static_cast<std::size_t>(other);
    const btVector3 a(side * mechanism_.rods[first].length / 2, 0, 0),
        b(mechanism_.rods[second].length / 2, 0, 0);
    const btVector3 axis(0, 0, 1);
    if (joint_ == 0) {
      keep(std::make_unique<btPoint2PointConstraint>(*bodies_[first], *bodies_[second], a, b));
    } else {
      keep(
          std::make_unique<btHingeConstraint>(*bodies_[first], *bodies_[second], a, b, axis, axis));
    }
  }

  void keep(std::unique_ptr<btTypedConstraint> constraint) {
    world_->addConstraint(constraint.get(), true);
    constraints_.push_back(std::move(constraint));
  }

  const Mechanism mechanism_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSphereShape shape_;
  std::unique_ptr<btMLCPSolverInterface> mlcp_;
  std::unique_ptr<btConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::size_t joint_ = 0;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
};

}  // namespace

std::unique_ptr<Engine> create_bodies(const Mechanism& mechanism, Settings& settings) {
  return std::make_unique<BodiesEngine>(mechanism, settings);
}

}  // namespace engines
