// Bullet's btMultiBody: a tree of revolute links on a fixed base; loops closed by point-to-point
// constraints.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolverInterface.h>

#include "bullet.hpp"

namespace engines {
namespace {

class MultibodyEngine final : public FixedStepEngine {
 public:
  MultibodyEngine(const Mechanism& mechanism, Settings& settings)
      : FixedStepEngine(settings),
        mechanism_(mechanism),
        dispatcher_(&configuration_),
        shape_(0.01),
        body_(static_cast<int>(mechanism.rods.size()), 0, btVector3(0, 0, 0), true, false),
        angles_(mechanism.rods.size()),
        rates_(mechanism.rods.size()) {
    const std::vector<std::string> solvers{"si", "dantzig", "lemke", "pgs"};
    mlcp_ = create_mlcp(solvers[settings.choice("solver", solvers)]);
    solver_ = mlcp_ ? std::make_unique<btMultiBodyMLCPConstraintSolver>(mlcp_.get())
                    : std::make_unique<btMultiBodyConstraintSolver>();
    world_ = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(),
                                                        &configuration_);
    world_->setGravity(btVector3(0, -kGravity, 0));
    apply(settings, world_->getSolverInfo());
    build();
    body_.useRK4Integration(settings.choice("integrator", {"euler", "rk4"}) == 1);
    world_->addMultiBody(&body_);
    for (int i = 0; i < body_.getNumLinks(); ++i) add_collider(i);
    for (const Loop& loop : mechanism.loops) close(loop);
  }
  ~MultibodyEngine() override {
    for (const auto& constraint : constraints_) world_->removeMultiBodyConstraint(constraint.get());
    for (const auto& collider : colliders_) world_->removeCollisionObject(collider.get());
    world_->removeMultiBody(&body_);
  }
  MultibodyEngine(const MultibodyEngine&) = delete;
  MultibodyEngine& operator=(const MultibodyEngine&) = delete;

  void read(std::vector<RodState>& states) const override {
    for (std::size_t i = 0; i < angles_.size(); ++i) {
      angles_[i] = body_.getJointPos(static_cast<int>(i));
      rates_[i] = body_.getJointVel(static_cast<int>(i));
    }
    states_of_joints(mechanism_, angles_, rates_, states);
  }

 protected:
  void do_step() override { world_->stepSimulation(step(), 0); }

 private:
  void build() {
    const btQuaternion aligned(0, 0, 0, 1);
    for (int i = 0; i < body_.getNumLinks(); ++i) {
      const Rod& rod = mechanism_.rods[static_cast<std::size_t>(i)];
      const Rod* up =
          rod.parent < 0 ? nullptr : &mechanism_.rods[static_cast<std::size_t>(rod.parent)];
      const btVector3 pin(up != nullptr ? up->length / 2 : rod.anchor, 0, 0),
          centre(rod.length / 2, 0, 0);
      body_.setupRevolute(i, rod.mass, btVector3(rod.inertia(), rod.inertia(), rod.inertia()),
                          rod.parent, aligned, btVector3(0, 0, 1), pin, centre, true);
    }
    body_.finalizeMultiDof();
    for (int i = 0; i < body_.getNumLinks(); ++i) {
      const Rod& rod = mechanism_.rods[static_cast<std::size_t>(i)];
      const Rod* up =
          rod.parent < 0 ? nullptr : &mechanism_.rods[static_cast<std::size_t>(rod.parent)];
      body_.setJointPos(i, rod.angle - (up != nullptr ? up->angle : 0.0));
      body_.setJointVel(i, rod.rate - (up != nullptr ? up->rate : 0.0));
    }
    body_.setLinearDamping(0);
    body_.setAngularDamping(0);
    body_.setUseGyroTerm(false);  // equal moments have none
    body_.setMaxCoordinateVelocity(1e6);
    btAlignedObjectArray<btQuaternion> rotations;
    btAlignedObjectArray<btVector3> positions;
    body_.forwardKinematics(rotations, positions);
  }

  /// Constraints belong to the islands of the links' colliders: without these they are not solved.
  /// They collide with nothing.
  void add_collider(int link) {
    auto collider = std::make_unique<btMultiBodyLinkCollider>(&body_, link);
    collider->setCollisionShape(&shape_);
    world_->addCollisionObject(collider.get(), 1, 0);
    body_.getLink(link).m_collider = collider.get();
    colliders_.push_back(std::move(collider));
  }

  void close(const Loop& loop) {
    const btScalar first = mechanism_.rods[static_cast<std::size_t>(loop.rod)].length / 2;
    const btScalar second = mechanism_.rods[static_cast<std::size_t>(loop.other)].length / 2;
    constraints_.push_back(std::make_unique<btMultiBodyPoint2Point>(
        &body_, loop.rod, &body_, loop.other, btVector3(first, 0, 0), btVector3(second, 0, 0)));
    constraints_.back()->setMaxAppliedImpulse(1e30);
    world_->addMultiBodyConstraint(constraints_.back().get());
  }

  const Mechanism mechanism_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSphereShape shape_;
  std::unique_ptr<btMLCPSolverInterface> mlcp_;
  std::unique_ptr<btMultiBodyConstraintSolver> solver_;
  btMultiBody body_;
  std::unique_ptr<btMultiBodyDynamicsWorld> world_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyPoint2Point>> constraints_;
  mutable std::vector<double> angles_, rates_;
};

}  // namespace

std::unique_ptr<Engine> create_multibody(const Mechanism& mechanism, Settings& settings) {
  return std::make_unique<MultibodyEngine>(mechanism, settings);
}

}  // namespace engines
