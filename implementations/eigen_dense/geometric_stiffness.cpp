// How the constraint forces change with q: the geometric stiffness of Eq. (16).
#include "geometric_stiffness.hpp"

namespace mbs::eigen_dense {

template <typename Scalar>
GeometricStiffness<Scalar>::GeometricStiffness(const Model& model, const StepSettings& settings,
                                               const Layout& layout)
    : dimension_(layout.dimension()),
      scale_(Scalar(settings.step * settings.step / 4)),
      weights_(Vector::Zero(model.constraints())) {
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
  Eigen::Index row = 0;
  const auto lower = [&](const auto& constraint, const Matrix3& B) {
    const auto shares = layout.shares({constraint.a, constraint.b, constraint.c, constraint.d});
    if (!shares.empty()) constraints_.push_back({shares, row, B});
    ++row;
  };
  for (const DotConstraint& dot : model.dot_constraints()) lower(dot, Matrix3::Identity());
  for (const BilinearConstraint& bilinear : model.bilinear_constraints()) {
    Matrix3 B;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) B(i, j) = Scalar(bilinear.B[i][j]);
    }
    lower(bilinear, B);
  }
}

template <typename Scalar>
template <int dimension, typename MatrixScalar>
void GeometricStiffness<Scalar>::add_blocks(Eigen::MatrixX<MatrixScalar>& T) const {
  using Block = Eigen::Matrix<Scalar, dimension, dimension>;
  for (const auto& [shares, row, B] : constraints_) {
    const Block weighted = weights_[row] * B.template topLeftCorner<dimension, dimension>();
    for (int j = 0; j < shares.count; ++j) {
      const Share& at_j = shares.items[j];
      for (int i = j; i < shares.count; ++i) {  // ascending coordinates: row >= column
        const Share& at_i = shares.items[i];
        const Block block = Scalar(at_i.in_u * at_j.in_w) * weighted +
                            Scalar(at_i.in_w * at_j.in_u) * weighted.transpose();  // Eq. (16)
        T.template block<dimension, dimension>(at_i.start, at_j.start) +=
            block.template cast<MatrixScalar>();
      }
    }
  }
}

template <typename Scalar>
template <int dimension>
void GeometricStiffness<Scalar>::add_products(const Scalar* x, Scalar* y) const {
  using Point = Eigen::Matrix<Scalar, dimension, 1>;
  for (const auto& [shares, row, full_B] : constraints_) {
    Point u = Point::Zero(), w = Point::Zero();
    for (const Share& share : shares) {
      const Eigen::Map<const Point> here(x + share.start);
      u += Scalar(share.in_u) * here;
      w += Scalar(share.in_w) * here;
    }
    const auto B = full_B.template topLeftCorner<dimension, dimension>();
    const Point along_u = weights_[row] * (B * w);
    const Point along_w = weights_[row] * (B.transpose() * u);
    for (const Share& share : shares) {
      Eigen::Map<Point>(y + share.start) +=
          Scalar(share.in_u) * along_u + Scalar(share.in_w) * along_w;  // Eq. (16)
    }
  }
}

template <typename Scalar>
template <typename MatrixScalar>
void GeometricStiffness<Scalar>::add_tangent(Eigen::MatrixX<MatrixScalar>& T) const {
  dimension_ == 2 ? add_blocks<2>(T) : add_blocks<3>(T);
}

template <typename Scalar>
void GeometricStiffness<Scalar>::add_product(const Vector& x, Vector& y) const {
  dimension_ == 2 ? add_products<2>(x.data(), y.data()) : add_products<3>(x.data(), y.data());
}

template class GeometricStiffness<double>;
template class GeometricStiffness<float>;
template void GeometricStiffness<double>::add_tangent(Eigen::MatrixX<double>&) const;
template void GeometricStiffness<double>::add_tangent(Eigen::MatrixX<float>&) const;
template void GeometricStiffness<float>::add_tangent(Eigen::MatrixX<float>&) const;

}  // namespace mbs::eigen_dense
