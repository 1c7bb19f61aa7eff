// Builds chains of rods and adds terms to them.
#include "ladder/term_models.hpp"

#include <cmath>
#include <functional>
#include <memory>

#include "model_math/kinematics.hpp"
#include "model_math/least_change.hpp"
#include "model_math/monotone_curve.hpp"
#include "run/settings.hpp"

namespace mbs {
namespace {

/// offset + amplitude sin(frequency t + phase).
class TermWave final : public TimeFunction::Kind {
 public:
  TermWave(double offset, double amplitude, double frequency, double phase)
      : offset_(offset), amplitude_(amplitude), frequency_(frequency), phase_(phase) {}
  TimeFunction::Sample at(double t) const override {
    const double s = std::sin(frequency_ * t + phase_), c = std::cos(frequency_ * t + phase_);
    return {offset_ + amplitude_ * s, amplitude_ * frequency_ * c,
            -amplitude_ * frequency_ * frequency_ * s};
  }

 private:
  double offset_, amplitude_, frequency_, phase_;
};

/// A wave whose value at t = 0 is `start`.
TimeFunction term_wave(double start, double amplitude, double frequency, double phase) {
  return TimeFunction(
      std::make_shared<TermWave>(start - amplitude * std::sin(phase), amplitude, frequency, phase));
}

/// A chain A (fixed), B, C, D, E of rods, G fixed aside, P driven, and in space the unit vectors
/// Z (free, perpendicular to AB and BC) and N (fixed).
class TermBuilder {
 public:
  static constexpr int A = 0, B = 1, C = 2, D = 3, E = 4, G = 5, P = 6, Z = 7, N = 8;

  explicit TermBuilder(int dimension) {
    data_.dimension = dimension;
    const bool spatial = dimension == 3;
    data_.points = {{"A", -1, {0.1, 0.2, 0.0}},
                    {"B", dimension, {0.9, -0.3, 0.0}},
                    {"C", 0, {1.5, 0.4, 0.0}},
                    {"D", 3 * dimension, {2.4, 0.1, spatial ? 0.5 : 0.0}},
                    {"E", 2 * dimension, {2.9, -0.7, spatial ? 0.2 : 0.0}},
                    {"G", -1, {2.0, 1.5, spatial ? 0.4 : 0.0}},
                    {"P", -1, {3.5, 0.2, spatial ? -0.3 : 0.0}}};
    if (spatial) {
      data_.points.push_back({"Z", 12, {0.0, 0.0, 1.0}, true});
      data_.points.push_back({"N", -1, {0.6, 0.0, 0.8}, true});
    }
    const int n = spatial ? 15 : 8;
    for (int i = 0; i < n; ++i) data_.mass.push_back({i, i, 0.0});
    data_.force.assign(static_cast<std::size_t>(n), 0.0);
    rod(A, B, 1.0);
    rod(B, C, 0.7);
    rod(C, D, 1.3);
    rod(D, E, 0.4);
    if (spatial) {
      for (int i = 12; i < 15; ++i) mass(i, i, 0.05);
      data_.dot_constraints.push_back({Z, N0(), Z, N0(), 0.0, "unit"});
      data_.dot_constraints.push_back({Z, N0(), A, B, 0.0, "Z AB"});
      data_.dot_constraints.push_back({Z, N0(), B, C, 0.0, "Z BC"});
    }
  }

  ModelData& data() { return data_; }
  [[nodiscard]] bool spatial() const { return data_.dimension == 3; }
  /// The axis of torsion springs and couples.
  [[nodiscard]] int axis() const { return spatial() ? Z : -1; }
  /// The origin as a point, for unit vectors.
  int N0() {
    if (origin_ < 0) {
      origin_ = static_cast<int>(data_.points.size());
      data_.points.push_back({"O", -1, {}});
    }
    return origin_;
  }

  void rod(int a, int b, double m) {
    for (int k = 0; k < data_.dimension; ++k) {
      const int ia = data_.points[a].offset, ib = data_.points[b].offset;
      if (ia >= 0) mass(ia + k, ia + k, m / 3);
      if (ib >= 0) mass(ib + k, ib + k, m / 3);
      if (ia >= 0 && ib >= 0) mass(std::max(ia, ib) + k, std::min(ia, ib) + k, m / 6);
      if (k == 1 && ia >= 0) data_.force[ia + k] -= 9.81 * m / 2;
      if (k == 1 && ib >= 0) data_.force[ib + k] -= 9.81 * m / 2;
    }
    data_.dot_constraints.push_back({a, b, a, b, 0.0, "rod"});
  }

  /// P moves; what it is connected to follows.
  void drive_point() {
    const auto& r = data_.points[P].position;
    data_.driven_points.push_back(
        {P,
         {term_wave(r[0], 0.1, 7.0, 0.3), term_wave(r[1], -0.15, 5.0, 1.0),
          term_wave(r[2], 0.05, 9.0, 0.0)}});
  }
  /// With the mass matrix of a rod from E to the driven P.
  void driven_rod() {
    drive_point();
    data_.dot_constraints.push_back({E, P, E, P, 0.0, "driven rod"});
    for (int k = 0; k < data_.dimension; ++k) {
      mass(data_.points[E].offset + k, data_.points[E].offset + k, 0.5 / 3);
      data_.driven_mass.push_back({data_.points[E].offset + k, P, k, 0.5 / 6});
    }
  }
  /// As bodies have that are no rods: x of B with y of B and of C.
  void mass_across_axes() {
    const int b = data_.points[B].offset, c = data_.points[C].offset;
    mass(b + 1, b, 0.05);
    mass(std::max(b, c + 1), std::min(b, c + 1), -0.04);
  }
  void drive_value(int constraint, double amplitude) { driven_.push_back({constraint, amplitude}); }
  int bilinear(int a, int b, int c, int d) {
    BilinearConstraint constraint{a, b, c, d, {}, 0.0, "bilinear"};
    for (int i = 0; i < data_.dimension; ++i) {
      for (int k = 0; k < data_.dimension; ++k) {
        constraint.B[i][k] = std::sin(1.0 + 3 * i + 2.3 * k);
      }
    }
    data_.bilinear_constraints.push_back(constraint);
    return static_cast<int>(data_.dot_constraints.size() + data_.bilinear_constraints.size()) - 1;
  }

  /// Values of the constraints from the start, then a velocity that fits them.
  Model finish() {
    settle_values();
    const Model draft(data_);
    const int n = draft.variables(), m = draft.constraints();
    std::vector<double> v(n), rate(m);
    for (int i = 0; i < n; ++i) v[i] = std::cos(1.7 * i);
    constraint_rate(draft, 0.0, draft.initial_position(), v, rate);
    const std::vector<double> excess =
        LeastChange(draft, 0.0, draft.initial_position()).solve(rate);
    for (int i = 0; i < n; ++i) v[i] -= excess[i];
    data_.initial_velocity = v;
    return Model(data_);
  }

 private:
  void mass(int row, int col, double value) {
    for (MassEntry& entry : data_.mass) {
      if (entry.row == row && entry.col == col) {
        entry.value += value;
        return;
      }
    }
    data_.mass.push_back({row, col, value});
  }

  void settle_values() {
    data_.initial_velocity.assign(data_.force.size(), 0.0);
    const Model draft(data_);
    std::vector<double> phi(draft.constraints());
    evaluate_constraints(draft, 0.0, draft.initial_position(), phi);
    std::size_t row = 0;
    for (auto& c : data_.dot_constraints) c.value += phi[row++];
    for (auto& c : data_.bilinear_constraints) c.value += phi[row++];
    for (auto& c : data_.linear_constraints) c.value += phi[row++];
    for (const auto& [constraint, amplitude] : driven_) {
      data_.driven_values.push_back({constraint, term_wave(phi[constraint], amplitude, 6.0, 0.7)});
    }
  }

  struct Driven {
    int constraint;
    double amplitude;
  };
  ModelData data_;
  std::vector<Driven> driven_;
  int origin_ = -1;
};

/// All that every variant with all terms but force laws serves.
void everything(TermBuilder& b) {
  constexpr int A = TermBuilder::A, B = TermBuilder::B, C = TermBuilder::C, D = TermBuilder::D,
                E = TermBuilder::E, G = TermBuilder::G, P = TermBuilder::P, N = TermBuilder::N;
  b.data().springs = {{D, G, 300.0, 4.0, 0.5, "tension"}, {B, E, 200.0, 0.0, 4.0, "push"}};
  b.data().torsion_springs = {{B, A, C, B, b.axis(), 12.0, 0.8, 0.4, "hinge"}};
  b.data().couples = {{D, C, b.spatial() ? N : -1, 2.0, "motor"}};
  b.driven_rod();
  b.mass_across_axes();
  if (b.spatial()) {
    const int d = b.data().points[D].offset;
    b.drive_value(b.bilinear(D, P, E, C), 0.05);
    b.data().linear_constraints = {{{{d, 0.6}, {d + 2, 0.8}}, 0.0, "line"}};
    b.drive_value(1, 0.05);
  } else {
    b.drive_value(b.bilinear(B, A, C, B), 0.05);
    b.data().springs.push_back({P, C, 100.0, 3.0, 1.0, "driven"});
  }
}

// Tables that the chain moves about in: both sides of a stop, the flat part and the steep one.
Curve stop() { return monotone_curve({0.9, 1.2, 1.3, 1.5, 2.5}, {-60, -5, 0, 0, 40}); }
Curve damper() { return monotone_curve({-2, -0.4, 0, 0.4, 2}, {-3, -1.5, 0, 2, 5}); }
Curve hinge() { return monotone_curve({-1, 0, 0.5, 2}, {-6, 0, 1, 15}); }

struct NamedTerm {
  const char *name, *equation;
  std::function<void(TermBuilder&)> add;
};

std::vector<NamedTerm> named_terms() {
  constexpr int A = TermBuilder::A, B = TermBuilder::B, C = TermBuilder::C, D = TermBuilder::D,
                E = TermBuilder::E, G = TermBuilder::G, P = TermBuilder::P, N = TermBuilder::N;
  return {
      {"chain", "Eq. (7)", [](TermBuilder&) {}},
      {"springs", "Eq. (11)",
       [](TermBuilder& b) {
         b.data().springs = {{D, G, 300.0, 0.0, 0.5, "tension"},
                             {B, E, 200.0, 0.0, 4.0, "compression"},
                             {G, C, 150.0, 0.0, 0.0, "no length"}};
       }},
      {"dampers", "Eq. (11)",
       [](TermBuilder& b) {
         b.data().springs = {{D, G, 0.0, 8.0, 0.0, "to the ground"}, {B, E, 0.0, 5.0, 0.0, "free"}};
       }},
      {"zero springs", "Eq. (11)",
       [](TermBuilder& b) {
         b.data().springs = {{D, G, 0.0, 0.0, 0.0, "nothing"}};
       }},
      {"spring to a driven point", "Eq. (11), step 0",
       [](TermBuilder& b) {
         b.drive_point();
         b.data().springs = {{E, P, 250.0, 6.0, 0.4, "driven"}, {P, C, 100.0, 3.0, 1.0, "driven"}};
       }},
      {"torsion springs", "Eq. (11)",
       [](TermBuilder& b) {
         b.data().torsion_springs = {
             {B, A, C, B, b.axis(), 12.0, 0.0, 0.4, "hinge"},
             {A, B, G, G == 0 ? A : (b.spatial() ? A : D), b.axis(), 0.0, 0.0, 0.0, "zero"}};
         if (b.spatial()) b.data().torsion_springs.pop_back();
       }},
      {"torsion dampers", "Eq. (11)",
       [](TermBuilder& b) {
         b.data().torsion_springs = {{B, A, C, B, b.axis(), 9.0, 0.8, -2.9, "hinge"}};
       }},
      {"couples", "Eq. (11)",
       [](TermBuilder& b) {
         b.data().couples = {{B, A, b.axis(), 3.0, "motor"}, {B, C, b.axis(), -1.5, "motor"}};
       }},
      {"force laws", "Eq. (18)",
       [](TermBuilder& b) {
         b.data().force_laws = {{D, G, {stop()}, "stop"}, {B, E, {stop(), {}, -0.5}, "pushed"}};
         b.data().torque_laws = {{B, A, C, B, b.axis(), {hinge()}, "hinge"}};
       }},
      {"force laws over rates", "Eq. (18)",
       [](TermBuilder& b) {
         b.data().force_laws = {{D, G, {stop(), damper()}, "stop"}, {B, E, {{}, damper()}, "free"}};
         b.data().torque_laws = {{B, A, C, B, b.axis(), {hinge(), damper()}, "hinge"}};
       }},
      {"force laws of time", "Eq. (18), step 0",
       [](TermBuilder& b) {
         b.drive_point();
         b.data().force_laws = {{E, P, {stop(), damper(), term_wave(1.0, 0.5, 9.0, 0.3)}, "driven"},
                                {D, G, {stop(), {}, term_wave(0.5, 0.7, 8.0, 0.0)}, "actuator"}};
         b.data().torque_laws = {
             {B, A, C, B, b.axis(), {{}, damper(), term_wave(-1, 1, 5, 1)}, "motor"}};
       }},
      {"driven rod", "Eqs. (6), (7), step 0, Q of a driven mass",
       [](TermBuilder& b) { b.driven_rod(); }},
      {"driven length", "Eqs. (6), (7), step 0", [](TermBuilder& b) { b.drive_value(1, 0.1); }},
      {"linear", "Eq. (8)",
       [](TermBuilder& b) {
         const int e = b.data().points[E].offset, d = b.data().points[D].offset;
         b.data().linear_constraints = {{{{e, 0.6}, {e + 1, 0.8}, {d, -0.3}}, 0.0, "line"}};
       }},
      {"driven linear", "Eqs. (6), (8), step 0",
       [](TermBuilder& b) {
         const int e = b.data().points[E].offset, d = b.data().points[D].offset;
         b.data().linear_constraints = {{{{e, 0.6}, {e + 1, 0.8}}, 0.0, "line"},
                                        {{{d + 1, 0.5}, {e + 1, -0.5}}, 0.0, "other"}};
         b.drive_value(static_cast<int>(b.data().dot_constraints.size()), 0.05);
       }},
      {"dot", "Eq. (7)",
       [](TermBuilder& b) {
         b.data().dot_constraints.push_back({B, A, E, D, 0.0, "dot"});
       }},
      {"dot with a driven direction", "Eqs. (6), (7), step 0",
       [](TermBuilder& b) {
         b.drive_point();
         b.data().dot_constraints.push_back({P, G, E, D, 0.0, "dot"});
       }},
      {"bilinear", "Eq. (7), bilinear", [](TermBuilder& b) { b.bilinear(B, A, E, D); }},
      {"bilinear with shared and fixed points", "Eq. (7), bilinear",
       [](TermBuilder& b) {
         b.bilinear(D, C, D, E);
         if (b.spatial()) b.bilinear(C, N, G, D);
       }},
      {"driven bilinear", "Eqs. (6), (7), bilinear, step 0",
       [](TermBuilder& b) {
         b.drive_point();
         b.drive_value(b.bilinear(D, P, E, C), 0.2);
       }},
      {"mass across axes", "all of M, Eqs. (3), (5)", [](TermBuilder& b) { b.mass_across_axes(); }},
      {"stored zeros", "all of M, Eqs. (3), (5)",
       [](TermBuilder& b) {
         b.data().mass.push_back({7, 0, 0.0});
         b.data().mass.push_back({6, 1, 0.0});
         b.data().springs = {{D, G, 300.0, 4.0, 0.5, "spring"}};
       }},
      {"everything", "Eqs. (6) to (8), (11), step 0", everything},
      {"everything and force laws", "Eqs. (6) to (8), (11), (18), step 0",
       [](TermBuilder& b) {
         everything(b);
         b.data().force_laws = {{D, G, {stop(), damper()}, "stop"},
                                {P, C, {stop(), {}, term_wave(0.5, 0.7, 8.0, 0.0)}, "actuator"}};
         b.data().torque_laws = {{B, A, C, B, b.axis(), {hinge(), damper()}, "hinge"}};
       }},
  };
}

}  // namespace

std::vector<TermModel> term_models() {
  std::vector<TermModel> models;
  for (const int dimension : {2, 3}) {
    for (const auto& [name, equation, add] : named_terms()) {
      TermBuilder builder(dimension);
      add(builder);
      models.push_back({std::string(name) + (dimension == 2 ? ", planar" : ", spatial"),
                        builder.finish(), equation});
    }
  }
  return models;
}

StepSettings term_settings(const Model& model, StepSettings settings) {
  settings.step = 2.5e-4;
  return chosen(model, settings);
}

std::vector<SettingCase> setting_cases() {
  constexpr auto saddle = Scheme::saddle_point;
  constexpr auto single = Precision::single_precision;
  constexpr auto mixed = Precision::mixed;
  return {
      {"saddle_point", {.scheme = saddle}},
      {"saddle_point_every_step", {.scheme = saddle, .tangent = TangentReuse::step}},
      {"saddle_point_kept", {.scheme = saddle, .tangent = TangentReuse::kept}},
      {"saddle_point_unprojected", {.projections = Projections::none, .scheme = saddle}},
      {"saddle_point_velocities",
       {.projections = Projections::velocity, .projections_every = 2, .scheme = saddle}},
      {"rattle", {.scheme = Scheme::rattle}},
      {"rattle4", {.scheme = Scheme::rattle4}},
      {"rattle6", {.scheme = Scheme::rattle6}},
      {"multistep6", {.scheme = Scheme::multistep6}},
      {"converged", {.multipliers = MultiplierUpdate::converged}},
      {"every_step", {.tangent = TangentReuse::step}},
      {"kept", {.tangent = TangentReuse::kept}},
      {"every_third", {.projections_every = 3}},
      {"single", {.precision = single}},
      {"single_saddle_point", {.scheme = saddle, .precision = single}},
      {"single_rattle", {.scheme = Scheme::rattle, .precision = single}},
      {"mixed", {.precision = mixed}},
      {"mixed_saddle_point", {.scheme = saddle, .precision = mixed}},
      {"geometric", {.geometric_stiffness = true}},
      {"geometric_kept", {.tangent = TangentReuse::kept, .geometric_stiffness = true}},
      {"saddle_point_geometric", {.scheme = saddle, .geometric_stiffness = true}},
      {"mixed_kept", {.tangent = TangentReuse::kept, .precision = mixed}},
  };
}

}  // namespace mbs
