// Homogeneous coordinates about the centre of mass, in units of the body's size.
#include "scene_file/body/rigid_body.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace mbs {
namespace {

/// Smallest share of the largest eigenvalue that counts as extent along an axis.
constexpr double kFlattest = 1e-8;
constexpr double kPoseRounding = 1e-14;

/// S, kg m^2: the second moments about the centre.
Eigen::Matrix3d second_moments(const Inertia& inertia, int dimension) {
  Eigen::Matrix3d J;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) {
      J(row, col) = inertia.tensor[static_cast<std::size_t>(row)][static_cast<std::size_t>(col)];
    }
  }
  if (dimension == 2) return J(2, 2) * Eigen::Matrix3d::Identity();
  return 0.5 * J.trace() * Eigen::Matrix3d::Identity() - J;
}

Eigen::Vector3d eigenvalues(const Eigen::Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

}  // namespace

bool is_inertia(const Inertia& inertia, int dimension) {
  const Eigen::Vector3d values = eigenvalues(second_moments(inertia, dimension));
  return values.allFinite() && values[0] > kFlattest * values[2];
}

double radius_of_gyration(const Inertia& inertia, int dimension) {
  return std::sqrt(eigenvalues(second_moments(inertia, dimension))[2] / inertia.mass);
}

Inertia with_point_mass(const Inertia& inertia, const Vector3& local, double mass, int dimension) {
  const double total = inertia.mass + mass;
  const Vector3 arm = local - inertia.centre;
  Inertia result = inertia;
  result.mass = total;
  result.centre = inertia.centre + (mass / total) * arm;
  const double reduced = inertia.mass / total * mass;  // of two masses that far apart
  const std::size_t first = dimension == 2 ? 2 : 0;
  for (std::size_t i = first; i < 3; ++i) {
    for (std::size_t j = first; j < 3; ++j) {
      const double squared = i == j ? dot(arm, arm) : 0.0;
      result.tensor[i][j] += reduced * (squared - arm[i] * arm[j]);
    }
  }
  return result;
}

BodyMass::BodyMass(const Inertia& inertia, int dimension, double size,
                   const std::vector<BodyPlace>& basis, const std::vector<BodyPlace>& further)
    : dimension_(dimension),
      size_(size),
      origin_(inertia.centre),
      basis_(basis),
      further_(further) {
  const auto members = static_cast<Eigen::Index>(basis.size());
  Matrix X(members, members);
  for (Eigen::Index k = 0; k < members; ++k) {
    X.col(k) = homogeneous(basis[static_cast<std::size_t>(k)]);
  }
  inverse_ = Eigen::FullPivLU<Matrix>(X).inverse();
  Matrix P = pseudo_inertia(inertia);
  const Matrix P_inverse = P.inverse();
  for (const BodyPlace& place : further) {  // mu h h^H <= P / (2 count) for every one of them
    const Column h = homogeneous(place);
    const double most = 1.0 / (h.adjoint() * P_inverse * h).value().real();
    shares_.push_back(most / (2.0 * static_cast<double>(further.size())));
  }
  for (std::size_t k = 0; k < further.size(); ++k) {
    const Column h = homogeneous(further[k]);
    P -= shares_[k] * h * h.adjoint();
  }
  mass_ = (inverse_ * P * inverse_.adjoint()).conjugate();
  weighing_ = (inverse_ * P.col(0)).conjugate();
}

BodyMass::Column BodyMass::homogeneous(const BodyPlace& place) const {
  const Vector3 p = (1.0 / size_) * (place.is_vector ? place.local : place.local - origin_);
  if (dimension_ == 2) {
    Column h(2);
    h << 1.0, Weight(p[0], p[1]);
    return h;
  }
  Column h(4);
  h << (place.is_vector ? 0.0 : 1.0), p[0], p[1], p[2];
  return h;
}

BodyMass::Matrix BodyMass::pseudo_inertia(const Inertia& inertia) const {
  const Eigen::Index size = dimension_ == 2 ? 2 : 4;
  Matrix P = Matrix::Zero(size, size);
  P(0, 0) = inertia.mass;
  const Eigen::Matrix3d S = second_moments(inertia, dimension_) / (size_ * size_);
  P.bottomRightCorner(size - 1, size - 1) = S.topLeftCorner(size - 1, size - 1);
  return P;
}

BodyMass::Weights BodyMass::weights(const BodyPlace& place) const {
  const Column w = inverse_ * homogeneous(place);
  Weights result;
  for (Eigen::Index k = 0; k < w.size(); ++k) {
    const bool is_vector = basis_[static_cast<std::size_t>(k)].is_vector;
    const double scale = (place.is_vector ? 1.0 : size_) / (is_vector ? 1.0 : size_);
    const auto clean = [&](double x) { return std::abs(x) > kPoseRounding * scale ? x : 0.0; };
    result.emplace_back(clean(w[k].real()), clean(w[k].imag()));
  }
  return result;
}

BodyMass::Weight BodyMass::mass(std::size_t i, std::size_t j) const {
  const auto row = static_cast<Eigen::Index>(i), col = static_cast<Eigen::Index>(j);
  const double scale = std::sqrt(std::abs(mass_(row, row)) * std::abs(mass_(col, col)));
  const auto clean = [&](double x) { return std::abs(x) > kPoseRounding * scale ? x : 0.0; };
  return {clean(mass_(row, col).real()), row == col ? 0.0 : clean(mass_(row, col).imag())};
}

BodyMass::Weight BodyMass::weighing(std::size_t i) const {
  return weighing_[static_cast<Eigen::Index>(i)];
}

double BodyMass::weighing_further(std::size_t k) const {
  return further_[k].is_vector ? 0.0 : shares_[k];
}

Matrix3 block_of(BodyMass::Weight weight, int dimension) {
  const double a = weight.real(), b = weight.imag();
  if (dimension == 2) return {{{a, -b, 0.0}, {b, a, 0.0}, {0.0, 0.0, 0.0}}};
  return {{{a, 0.0, 0.0}, {0.0, a, 0.0}, {0.0, 0.0, a}}};
}

}  // namespace mbs
