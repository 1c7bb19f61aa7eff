// Simbody: a tree of pin mobilizers in joint coordinates; loops closed by constraints that its
// integrators keep on their manifold by projection.
#include <simbody/Simbody.h>

#include "engine.hpp"

namespace engines {
namespace {

using namespace SimTK;

const std::vector<std::string> kIntegrators{
    "merson", "feldberg", "rk3", "rk2", "verlet", "euler2", "euler", "cpodes-bdf", "cpodes-adams"};

class SimbodyEngine final : public Engine {
 public:
  SimbodyEngine(const Mechanism& mechanism, Settings& settings, double duration)
      : mechanism_(mechanism), matter_(system_), forces_(system_) {
    Force::Gravity(forces_, matter_, Vec3(0, -kGravity, 0));
    for (const Rod& rod : mechanism.rods) add(rod);
    const auto closure = settings.choice("closure", {"line", "ball"});
    for (const Loop& loop : mechanism.loops) close(loop, closure == 0);
    State state = system_.realizeTopology();
    start(state);
    integrator_ = create_integrator(settings);
    integrator_->setReturnEveryInternalStep(true);
    integrator_->setFinalTime(duration);
    integrator_->initialize(state);
  }

  double advance(double end) override {
    integrator_->stepTo(end);
    const double t = integrator_->getTime();
    return integrator_->isSimulationOver() || t > end * (1 - 1e-12) ? end : t;
  }

  void read(std::vector<RodState>& states) const override {
    const State& state = integrator_->getState();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      angles_[i] = bodies_[i].getAngle(state);
      rates_[i] = bodies_[i].getRate(state);
    }
    states_of_joints(mechanism_, angles_, rates_, states);
  }

 private:
  void add(const Rod& rod) {
    const Vec3 centre(rod.length / 2, 0, 0);
    const Inertia about_pin = Inertia(rod.inertia()) + Inertia(centre, rod.mass);
    const Body::Rigid body(MassProperties(rod.mass, centre, about_pin));
    if (rod.parent < 0) {
      bodies_.emplace_back(matter_.Ground(), Transform(Vec3(rod.anchor, 0, 0)), body, Transform());
    } else {
      const auto up = static_cast<std::size_t>(rod.parent);
      bodies_.emplace_back(bodies_[up], Transform(Vec3(mechanism_.rods[up].length, 0, 0)), body,
                           Transform());
    }
    angles_.push_back(0.0);
    rates_.push_back(0.0);
  }

  /// A point on a line across the plane is the pin of a planar loop in its two equations; a ball
  /// joint's third is redundant.
  void close(const Loop& loop, bool by_line) {
    const auto first = static_cast<std::size_t>(loop.rod),
               second = static_cast<std::size_t>(loop.other);
    const Vec3 a(mechanism_.rods[first].length, 0, 0), b(mechanism_.rods[second].length, 0, 0);
    if (by_line) {
      Constraint::PointOnLine(bodies_[second], UnitVec3(ZAxis), b, bodies_[first], a);
    } else {
      Constraint::Ball(bodies_[second], b, bodies_[first], a);
    }
  }

  void start(State& state) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Rod& rod = mechanism_.rods[i];
      const bool ground = rod.parent < 0;
      const Rod& up = mechanism_.rods[static_cast<std::size_t>(ground ? 0 : rod.parent)];
      bodies_[i].setAngle(state, rod.angle - (ground ? 0.0 : up.angle));
      bodies_[i].setRate(state, rod.rate - (ground ? 0.0 : up.rate));
    }
  }

  std::unique_ptr<Integrator> create_integrator(Settings& settings) {
    std::unique_ptr<Integrator> made;
    const auto kind = settings.choice("integrator", kIntegrators);
    switch (kind) {
      case 0:
        made = std::make_unique<RungeKuttaMersonIntegrator>(system_);
        break;
      case 1:
        made = std::make_unique<RungeKuttaFeldbergIntegrator>(system_);
        break;
      case 2:
        made = std::make_unique<RungeKutta3Integrator>(system_);
        break;
      case 3:
        made = std::make_unique<RungeKutta2Integrator>(system_);
        break;
      case 4:
        made = std::make_unique<VerletIntegrator>(system_);
        break;
      case 5:
        made = std::make_unique<SemiExplicitEuler2Integrator>(system_);
        break;
      case 6:
        made = std::make_unique<SemiExplicitEulerIntegrator>(system_, 1e-3);
        break;
      case 7:
        made = std::make_unique<CPodesIntegrator>(system_, CPodes::BDF);
        break;
      default:
        made = std::make_unique<CPodesIntegrator>(system_, CPodes::Adams);
    }
    const double accuracy = settings.positive("accuracy", 1e-3);  // Simbody's own value
    made->setAccuracy(accuracy);
    made->setConstraintTolerance(settings.positive("tolerance", accuracy / 10));
    // A step of one length instead of error control.
    if (const double step = settings.number("step", 0.0); step > 0.0) made->setFixedStepSize(step);
    return made;
  }

  const Mechanism mechanism_;
  MultibodySystem system_;
  SimbodyMatterSubsystem matter_;
  GeneralForceSubsystem forces_;
  std::vector<MobilizedBody::Pin> bodies_;
  std::unique_ptr<Integrator> integrator_;
  mutable std::vector<double> angles_, rates_;
};

std::unique_ptr<Engine> create(const Mechanism& mechanism, Settings& settings, double duration) {
  return std::make_unique<SimbodyEngine>(mechanism, settings, duration);
}

std::string version() {
  int major = 0, minor = 0, patch = 0;
  SimTK_version_simbody(&major, &minor, &patch);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

}  // namespace
}  // namespace engines

int main(int argc, char** argv) {
  return engines::run_program({"simbody", engines::version(), engines::create}, argc, argv);
}
