// Gauss points on each span between two nodes, at which all cardinal splines are evaluated.
#include "scene/families/beam_mass.hpp"

#include <Eigen/Dense>
#include <array>

namespace mbs {
namespace {

/// Second derivatives at the nodes are this matrix times the values there: zero at the ends, and
/// (S_(i-1) + 4 S_i + S_(i+1)) h^2 / 6 = y_(i-1) - 2 y_i + y_(i+1) between them.
Eigen::MatrixXd spline_curvatures(int nodes, double h) {
  Eigen::MatrixXd left = Eigen::MatrixXd::Identity(nodes, nodes);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(nodes, nodes);
  for (int i = 1; i + 1 < nodes; ++i) {
    left.row(i).segment(i - 1, 3) << 1.0, 4.0, 1.0;
    right.row(i).segment(i - 1, 3) << 1.0, -2.0, 1.0;
  }
  return 6.0 / (h * h) * left.partialPivLu().solve(right);
}

/// Of 4 points on 0 ... 1, exact for the products of cubics.
constexpr std::array<std::array<double, 2>, 4> kBeamGauss{
    {{0.0694318442029737, 0.1739274225687269},
     {0.3300094782075719, 0.3260725774312731},
     {0.6699905217924281, 0.3260725774312731},
     {0.9305681557970263, 0.1739274225687269}}};

}  // namespace

Eigen::MatrixXd beam_mass(const BeamShape& beam) {
  const int n = beam.nodes, spans = n - 1;
  const double h = beam.length / spans;
  const Eigen::MatrixXd S = spline_curvatures(n, h);
  // A row a Gauss point: values and derivatives of all N, times the root of the mass there.
  Eigen::MatrixXd N(4 * spans, n), D(4 * spans, n);
  for (int e = 0; e < spans; ++e) {
    for (int g = 0; g < 4; ++g) {
      const auto [x, weight] = kBeamGauss[static_cast<std::size_t>(g)];
      const double y = 1.0 - x, root = std::sqrt(weight * beam.mass / spans);
      Eigen::RowVectorXd value =
          h * h / 6.0 * ((y * y * y - y) * S.row(e) + (x * x * x - x) * S.row(e + 1));
      Eigen::RowVectorXd slope =
          h / 6.0 * ((1.0 - 3.0 * y * y) * S.row(e) + (3.0 * x * x - 1.0) * S.row(e + 1));
      value[e] += y;
      value[e + 1] += x;
      slope[e] -= 1.0 / h;
      slope[e + 1] += 1.0 / h;
      N.row(4 * e + g) = root * value;
      D.row(4 * e + g) = root * slope;
    }
  }
  const double square = beam.offset * beam.offset + beam.gyration * beam.gyration;  // mean y^2
  const Eigen::MatrixXd ND = N.transpose() * D;
  const Eigen::MatrixXd straight = N.transpose() * N + square * D.transpose() * D;
  const Eigen::MatrixXd turned = beam.offset * (ND - ND.transpose());
  Eigen::MatrixXd M(2 * n, 2 * n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      M.block<2, 2>(2 * i, 2 * j) << straight(i, j), -turned(i, j), turned(i, j), straight(i, j);
    }
  }
  return M;
}

}  // namespace mbs
