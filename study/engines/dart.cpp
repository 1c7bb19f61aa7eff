// DART: skeletons of revolute joints in joint coordinates; loops closed by ball joint constraints,
// impulses in its linear complementarity problem.
#include <dart/constraint/BallJointConstraint.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/simulation/World.hpp>

#include "engine.hpp"

namespace engines {
namespace {

using namespace dart;

class DartEngine final : public FixedStepEngine {
 public:
  DartEngine(const Mechanism& mechanism, Settings& settings)
      : FixedStepEngine(settings), mechanism_(mechanism), world_(simulation::World::create()) {
    world_->setGravity(Eigen::Vector3d(0, -kGravity, 0));
    world_->setTimeStep(step());
    set_solver(settings);
    const bool one = settings.choice("skeletons", {"trees", "one"}) == 1;
    for (const Rod& rod : mechanism.rods) add(rod, one);
    for (const auto& skeleton : skeletons_) world_->addSkeleton(skeleton);
    for (const Loop& loop : mechanism.loops) {
      auto* body = bodies_[static_cast<std::size_t>(loop.rod)];
      const double length = mechanism.rods[static_cast<std::size_t>(loop.rod)].length;
      world_->getConstraintSolver()->addConstraint(
          std::make_shared<constraint::BallJointConstraint>(
              body, bodies_[static_cast<std::size_t>(loop.other)],
              body->getTransform() * Eigen::Vector3d(length, 0, 0)));
    }
  }

  void read(std::vector<RodState>& states) const override {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      angles_[i] = joints_[i]->getPosition(0);
      rates_[i] = joints_[i]->getVelocity(0);
    }
    states_of_joints(mechanism_, angles_, rates_, states);
  }

 protected:
  void do_step() override { world_->step(); }

 private:
  /// What is left out are DART's own values.
  void set_solver(Settings& settings) {
    using constraint::DynamicJointConstraint;
    DynamicJointConstraint::setErrorReductionParameter(settings.number("erp", 0.01));
    DynamicJointConstraint::setMaxErrorReductionVelocity(settings.number("max-velocity", 0.1));
    DynamicJointConstraint::setConstraintForceMixing(settings.positive("cfm", 1e-5));
    auto solver = std::make_unique<constraint::BoxedLcpConstraintSolver>();
    if (settings.choice("solver", {"dantzig", "pgs"}) == 1) {
      auto pgs = std::make_shared<constraint::PgsBoxedLcpSolver>();
      constraint::PgsBoxedLcpSolver::Option option;
      option.mMaxIteration = static_cast<int>(settings.positive("iterations", 30));
      pgs->setOption(option);
      solver->setBoxedLcpSolver(pgs);
      solver->setSecondaryBoxedLcpSolver(nullptr);
    }
    world_->setConstraintSolver(std::move(solver));
  }

  /// A skeleton for each tree on the ground: an impulse then reaches no further than its own.
  void add(const Rod& rod, bool one_skeleton) {
    const bool ground = rod.parent < 0;
    const auto up = static_cast<std::size_t>(ground ? 0 : rod.parent);
    if (ground && (skeletons_.empty() || !one_skeleton))
      skeletons_.push_back(dynamics::Skeleton::create("s" + std::to_string(skeletons_.size())));
    const auto skeleton = ground ? skeletons_.back() : bodies_[up]->getSkeleton();
    dynamics::RevoluteJoint::Properties joint;
    dynamics::BodyNode::Properties body;
    const std::string name = "r" + std::to_string(joints_.size());  // or it says what it made up
    joint.mName = body.mName = name;
    joint.mAxis = Eigen::Vector3d::UnitZ();
    joint.mT_ParentBodyToJoint.translation() =
        Eigen::Vector3d(ground ? rod.anchor : mechanism_.rods[up].length, 0, 0);
    body.mInertia = dynamics::Inertia(rod.mass, Eigen::Vector3d(rod.length / 2, 0, 0),
                                      rod.inertia() * Eigen::Matrix3d::Identity());
    const auto made = skeleton->createJointAndBodyNodePair<dynamics::RevoluteJoint>(
        ground ? nullptr : bodies_[up], joint, body);
    joints_.push_back(made.first);
    bodies_.push_back(made.second);
    made.first->setPosition(0, rod.angle - (ground ? 0.0 : mechanism_.rods[up].angle));
    made.first->setVelocity(0, rod.rate - (ground ? 0.0 : mechanism_.rods[up].rate));
    angles_.push_back(0.0);
    rates_.push_back(0.0);
  }

  const Mechanism mechanism_;
  simulation::WorldPtr world_;
  std::vector<dynamics::SkeletonPtr> skeletons_;
  std::vector<dynamics::RevoluteJoint*> joints_;
  std::vector<dynamics::BodyNode*> bodies_;
  mutable std::vector<double> angles_, rates_;
};

std::unique_ptr<Engine> create(const Mechanism& mechanism, Settings& settings, double) {
  return std::make_unique<DartEngine>(mechanism, settings);
}

}  // namespace
}  // namespace engines

int main(int argc, char** argv) {
  return engines::run_program({"dart", ENGINE_VERSION, engines::create}, argc, argv);
}
