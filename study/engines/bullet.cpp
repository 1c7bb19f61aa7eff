// Bullet: the program, and what both ways of modelling share.
#include "bullet.hpp"

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btLemkeSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>

namespace engines {

std::unique_ptr<btMLCPSolverInterface> create_mlcp(const std::string& name) {
  if (name == "dantzig") return std::make_unique<btDantzigSolver>();
  if (name == "lemke") return std::make_unique<btLemkeSolver>();
  if (name == "pgs") return std::make_unique<btSolveProjectedGaussSeidel>();
  return nullptr;
}

void apply(Settings& settings, btContactSolverInfo& info) {
  info.m_numIterations = static_cast<int>(settings.positive("iterations", 10));
  info.m_erp = info.m_erp2 = settings.number("erp", 0.2);
  info.m_globalCfm = settings.number("cfm", 0.0);
  info.m_leastSquaresResidualThreshold = 0;  // all iterations that are asked for
}

namespace {

std::unique_ptr<Engine> create(const Mechanism& mechanism, Settings& settings, double) {
  const bool multibody = settings.choice("model", {"multibody", "bodies"}) == 0;
  return multibody ? create_multibody(mechanism, settings) : create_bodies(mechanism, settings);
}

std::string version() {
  return std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100) +
         (btIsDoublePrecision() ? " double precision" : " single precision");
}

}  // namespace
}  // namespace engines

int main(int argc, char** argv) {
  return engines::run_program({"bullet", engines::version(), engines::create}, argc, argv);
}
