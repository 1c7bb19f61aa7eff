// The two ways of modelling in Bullet, and what their worlds share.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "engine.hpp"

class btMLCPSolverInterface;

namespace engines {

/// Free rigid bodies in the plane, joined by constraints.
std::unique_ptr<Engine> create_bodies(const Mechanism& mechanism, Settings& settings);
/// Featherstone's algorithm on a tree of hinges in joint coordinates, loops closed by constraints.
std::unique_ptr<Engine> create_multibody(const Mechanism& mechanism, Settings& settings);

/// The solver of mixed linear complementarity problems that `name` means; null if none.
std::unique_ptr<btMLCPSolverInterface> create_mlcp(const std::string& name);

/// Settings of the solver that both have: iterations, erp, cfm. Bullet's own values are usual.
void apply(Settings& settings, btContactSolverInfo& info);

}  // namespace engines
