// Saddle-point forms whose masses never change: solves with the points eliminated once.
#include <cstdio>
#include <random>

#include "system.hpp"

namespace {

using namespace mbs;                // NOLINT: a test of this implementation alone
using namespace mbs::compiled_ldl;  // NOLINT

using Random = std::mt19937;
double number(Random& random) { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); }

/// What a scene has besides rods.
struct Kind {
  int dimension = 2, clusters = 1, points = 12;  // of each cluster
  bool others = false;                           // constraints that are no distances
  bool full_masses = true;                       // M couples all points of a cluster, or neighbours
  bool axes_alike = false;                       // M is the same in all axes, no linear constraints
};

/// Clusters in a row, rods within and between them.
ModelData scene(Random& random, const Kind& kind) {
  const int D = kind.dimension, free = kind.clusters * kind.points;
  ModelData data;
  data.dimension = D;
  data.points.push_back({.name = "A"});
  for (int i = 0; i < free; ++i) data.points.push_back({.name = "B", .offset = D * i});
  for (int i = 0; kind.axes_alike && i < free; ++i) {
    for (int j = i / kind.points * kind.points; j <= i; ++j) {
      const double value = i == j ? 10.0 + number(random) : 0.1 * number(random);
      for (int x = 0; x < D; ++x) data.mass.push_back({D * i + x, D * j + x, value});
    }
  }
  for (int i = 0; !kind.axes_alike && i < D * free; ++i) {
    for (int j = 0; j <= i; ++j) {
      const bool same = i / D / kind.points == j / D / kind.points;
      const bool coupled = same && (kind.full_masses || i / D - j / D <= 1);
      if (i == j) data.mass.push_back({i, j, 10.0 + number(random)});
      if (i > j && coupled) data.mass.push_back({i, j, 0.1 * number(random)});
    }
  }
  for (int i = 1; i <= free; ++i) {
    data.dot_constraints.push_back({i - 1, i, i - 1, i, 1.0, "rod"});
    if (i % 3 == 1 && i > 1) data.dot_constraints.push_back({i, i - 2, i, i - 2, 1.0, "rod"});
  }
  for (int i = 3; kind.others && i <= free; i += 4) {
    data.dot_constraints.push_back({i - 3, i - 1, i - 1, i, 0.0, "angle"});
    BilinearConstraint bilinear{.a = i - 2, .b = i, .c = i - 1, .d = i, .name = "turned"};
    for (int x = 0; x < D; ++x) {
      for (int y = 0; y < D; ++y) bilinear.B[x][y] = number(random);
    }
    data.bilinear_constraints.push_back(bilinear);
    if (kind.axes_alike) continue;
    data.linear_constraints.push_back({{{D * i - 1, 1.0}, {D * i - D - 1, -0.5}}, 0.0, "line"});
  }
  for (int i = 0; i < D * free; ++i) data.force.push_back(number(random));
  data.initial_velocity.resize(D * free, 0.0);
  return data;
}

void fill_random(Random& random, Array<double>& x, int size) {
  for (int i = 0; i < size; ++i) x[i] = number(random);
}

/// Largest residual of Eq. (12) for what is in s.y, with the gradients of the last evaluation.
template <int D>
double residual(System<double, double, D>& s, const Array<double>& given) {
  const Array<double> x = s.y;
  Array<double> mu(s.constraints.count()), rows = mu, left = x;
  Array<double> points(s.rows.extent, 0.0);
  for (int k = 0; k < s.constraints.count(); ++k) mu[k] = x[s.constraints.row(k)];
  for (const int row : s.rows.of_coordinate) points[row] = x[row];
  s.product(points.data());
  s.constraints.add_transposed(mu.data(), 1.0, s.y.data());
  s.constraints.product(points.data(), rows.data());
  double worst = 0.0;
  for (const int row : s.rows.of_coordinate)
    worst = std::max(worst, std::fabs(s.y[row] - given[row]));
  for (int k = 0; k < s.constraints.count(); ++k) {
    const double r = rows[k] - s.epsilon * mu[k] - given[s.constraints.row(k)];
    worst = std::max(worst, std::fabs(r));
  }
  return worst;
}

/// The right-hand side of a pass of Newton's method.
template <int D>
Array<double> right_hand_side(System<double, double, D>& s) {
  Array<double> given = s.y;
  s.mass.residual(s.force.data(), s.a.data(), s.h, given.data());
  s.constraints.add_forces(s.lambda.data(), s.phi.data(), 0.0, s.h, given.data());
  for (int k = 0; k < s.constraints.count(); ++k) given[s.constraints.row(k)] = -s.phi[k];
  return given;
}

/// Of a pass that makes factors, and of one elsewhere that reuses them.
template <int D>
double residual_of_passes(Random& random, System<double, double, D>& s) {
  fill_random(random, s.lambda, s.constraints.count());
  for (const int row : s.rows.of_coordinate) s.a[row] = number(random);
  Array<double> given = right_hand_side(s);
  s.begin_residual();
  s.assemble();
  s.finish_residual();
  if (!s.factorize_and_solve()) return 5.0;
  const double of_first = residual(s, given);
  const Array<double> q = s.q;
  fill_random(random, s.q, s.program.size);
  s.evaluate();
  given = right_hand_side(s);
  s.begin_residual(false);
  s.finish_residual();
  s.solve();
  s.q = q;
  s.evaluate();
  return std::max(of_first, residual(s, given));
}

/// Of a factorization, and of solves with its factors at another position, one of them without
/// forces on the points; from 1 on if the points are not eliminated once, in fewer than `fronts`,
/// or not as M asks for.
template <int D>
double worst_residual(Random& random, const Kind& kind, std::size_t fronts) {
  const Model model(scene(random, kind));
  const StepSettings settings{.step = 1.0, .penalty = 1e3, .scheme = Scheme::saddle_point};
  System<double, double, D> s(std::vector<const Model*>{&model},
                              std::vector<StepSettings>{settings});
  if (s.program.constant_fronts == 0) return 1.0;
  if (changing_of(model).axes_alike != kind.axes_alike) return 6.0;
  if (kind.clusters == 1 && !s.program.inverts_points) return 7.0;
  if (s.program.fronts.size() - s.program.constant_fronts < fronts) return 2.0;
  double worst = 0.0;
  for (int again = 0; again < 3; ++again) {
    fill_random(random, s.q, s.program.size);
    const Array<double> q = s.q;
    s.evaluate();
    worst = std::max(worst, residual_of_passes(random, s));
    for (int solve = 0; solve < 3; ++solve) {
      fill_random(random, s.y, s.program.size);
      if (solve == 2) {
        for (const int row : s.rows.of_coordinate) s.y[row] = 0.0;
      }
      const Array<double> given = s.y;
      if (solve == 0) s.assemble();
      if (solve == 0 && !s.factorize_and_solve()) return 3.0;
      if (solve > 0) {
        fill_random(random, s.q, s.program.size);
        s.evaluate();
        s.solve();
        s.q = q;
        s.evaluate();
      }
      worst = std::max(worst, residual(s, given));
    }
  }
  s.y[0] = std::nan("");
  s.q[0] = std::nan("");
  s.evaluate();
  s.assemble();
  return s.factorize_and_solve() ? 4.0 : worst;
}

bool is_kept_whole(const char* name, const ModelData& data, const StepSettings& settings) {
  if (program_of(Model(data), settings, 8).constant_fronts == 0) return true;
  std::printf("%s: points are eliminated once\n", name);
  return false;
}

}  // namespace

int main() {
  Random random(1);
  bool all = true;
  for (const bool others : {false, true}) {
    for (const int clusters : {1, 5}) {
      const std::size_t fronts = clusters > 1 ? 2 : 1;
      for (const bool alike : {false, true}) {
        const double planar =
            worst_residual<2>(random, {2, clusters, others ? 30 : 12, others, true, alike}, fronts);
        const double spatial =
            worst_residual<3>(random, {3, clusters, others ? 24 : 8, others, true, alike}, fronts);
        if (planar < 1e-9 && spatial < 1e-9) continue;
        std::printf("others %d, clusters %d, axes alike %d: residuals %g %g\n", others, clusters,
                    alike, planar, spatial);
        all = false;
      }
    }
  }
  const StepSettings saddle{.scheme = Scheme::saddle_point};
  ModelData full = scene(random, {});
  StepSettings single = saddle, curved = saddle;
  single.precision = Precision::single_precision;
  curved.geometric_stiffness = true;
  all &= is_kept_whole("sparse masses", scene(random, {2, 1, 40, false, false}), saddle);
  all &= is_kept_whole("penalty form", full, {});
  all &= is_kept_whole("single precision", full, single);
  all &= is_kept_whole("geometric stiffness", full, curved);
  full.springs.push_back({.a = 1, .b = 2, .stiffness = 1.0, .length = 1.0, .name = "spring"});
  all &= is_kept_whole("a spring", full, saddle);
  return all ? 0 : 1;
}
