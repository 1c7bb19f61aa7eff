// Orthogonal Procrustes in space, a complex quotient in the plane.
#include "scene_file/body/rigid_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace mbs {
namespace {

constexpr double kIndependent = 1e-6;  // smallest share of the largest direction that counts

Eigen::Vector3d eigen(const Vector3& x) { return {x[0], x[1], x[2]}; }
Vector3 vector(const Eigen::Vector3d& x) { return {x[0], x[1], x[2]}; }

Vector3 middle(const std::vector<Sighting>& sightings, Vector3 Sighting::*of) {
  Vector3 sum{};
  double points = 0.0;
  for (const Sighting& sighting : sightings) {
    if (sighting.is_vector) continue;
    sum = sum + sighting.*of;
    points += 1.0;
  }
  return points > 0.0 ? (1.0 / points) * sum : sum;
}

/// Sum of global local^T about the middles.
Eigen::Matrix3d correlation(const std::vector<Sighting>& sightings, double size) {
  const Vector3 local = middle(sightings, &Sighting::local);
  const Vector3 global = middle(sightings, &Sighting::global);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Sighting& s : sightings) {
    const Vector3 x = s.is_vector ? s.local : (1.0 / size) * (s.local - local);
    const Vector3 y = s.is_vector ? s.global : (1.0 / size) * (s.global - global);
    sum += eigen(y) * eigen(x).transpose();
  }
  return sum;
}

std::optional<Matrix3> fit_rotation(const std::vector<Sighting>& sightings, int dimension,
                                    double size) {
  const Eigen::Matrix3d C = correlation(sightings, size);
  if (dimension == 2) {
    const double c = C(0, 0) + C(1, 1), s = C(1, 0) - C(0, 1);
    if (!(std::hypot(c, s) > kIndependent * kIndependent)) return std::nullopt;
    return rotation_matrix({0.0, 0.0, std::atan2(s, c)});
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(C, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d values = svd.singularValues();
  if (!(values[1] > kIndependent * kIndependent * values[0])) return std::nullopt;
  Eigen::Matrix3d U = svd.matrixU();
  if (U.determinant() * svd.matrixV().determinant() < 0.0) U.col(2) *= -1.0;
  const Eigen::Matrix3d R = U * svd.matrixV().transpose();
  Matrix3 result{};
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) {
      result[static_cast<std::size_t>(row)][static_cast<std::size_t>(col)] = R(row, col);
    }
  }
  return result;
}

}  // namespace

Matrix3 rotation_matrix(const Vector3& rotation) {  // Rodrigues
  const double angle = std::hypot(rotation[0], rotation[1], rotation[2]);
  const Vector3 e = angle > 0.0 ? (1.0 / angle) * rotation : rotation;
  const double c = std::cos(angle), s = std::sin(angle);
  Matrix3 R{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) R[i][j] = (1 - c) * e[i] * e[j] + (i == j ? c : 0.0);
  }
  R[0][1] -= s * e[2];
  R[1][0] += s * e[2];
  R[0][2] += s * e[1];
  R[2][0] -= s * e[1];
  R[1][2] -= s * e[0];
  R[2][1] += s * e[0];
  return R;
}

std::optional<Pose> fit_pose(const std::vector<Sighting>& sightings, int dimension, double size) {
  const bool has_point =
      std::any_of(sightings.begin(), sightings.end(), [](const auto& s) { return !s.is_vector; });
  if (!has_point) return std::nullopt;
  std::vector<Sighting> exact;
  std::copy_if(sightings.begin(), sightings.end(), std::back_inserter(exact),
               [](const auto& s) { return s.is_exact; });
  std::optional<Matrix3> R = fit_rotation(exact, dimension, size);
  if (!R) R = fit_rotation(sightings, dimension, size);
  if (!R) return std::nullopt;
  const Vector3 local = middle(sightings, &Sighting::local);
  return Pose{middle(sightings, &Sighting::global) - multiply(*R, local), *R};
}

std::optional<Twist> fit_twist(const std::vector<Sighting>& sightings, int dimension) {
  Twist twist{middle(sightings, &Sighting::local), middle(sightings, &Sighting::global), {}};
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();  // the normal equations of the spin
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Sighting& s : sightings) {
    const Eigen::Vector3d arm = eigen(s.is_vector ? s.local : s.local - twist.at);
    N += arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose();
    right += arm.cross(eigen(s.is_vector ? s.global : s.global - twist.velocity));
  }
  const bool has_point = std::any_of(sightings.begin(), sightings.end(),
                                     [](const Sighting& s) { return !s.is_vector; });
  if (!has_point || !N.allFinite() || !right.allFinite()) return std::nullopt;
  if (dimension == 2) {
    if (!(N(2, 2) > 0.0)) return std::nullopt;
    twist.spin[2] = right[2] / N(2, 2);
    return twist;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(N);
  const Eigen::Vector3d values = principal.eigenvalues();
  if (!(values[0] > kIndependent * kIndependent * values[2])) return std::nullopt;
  const Eigen::Matrix3d axes = principal.eigenvectors();
  twist.spin = vector(axes * (axes.transpose() * right).cwiseQuotient(values));
  return twist;
}

}  // namespace mbs
