// Springs, laws and couples: their part of Q and, matrix-free, of C and K.
#include "forces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace mbs::eigen_dense {

namespace {

template <int dimension, typename Scalar>
using Point = Eigen::Matrix<Scalar, dimension, 1>;

/// z × x, where z starts at `axis` in the extended position q; planar: z = (0, 0, 1).
template <int dimension, typename Scalar>
Point<dimension, Scalar> turned(const Scalar* q, Eigen::Index axis,
                                const Point<dimension, Scalar>& x) {
  if constexpr (dimension == 2) {
    return {-x.y(), x.x()};
  } else {
    return Eigen::Map<const Point<3, Scalar>>(q + axis).cross(x);
  }
}

}  // namespace

template <typename Scalar>
Forces<Scalar>::Forces(const Model& model, const StepSettings& settings, const Layout& layout)
    : dimension_(layout.dimension()),
      half_step_(Scalar(settings.step / 2)),
      scale_(Scalar(settings.step * settings.step / 4)) {
  lower_elements(model, layout);
  lower_couples(model, layout);
}

template <typename Scalar>
void Forces<Scalar>::lower_elements(const Model& model, const Layout& layout) {
  const auto lower_line = [&](const auto& one, double rest, const auto& law, auto& lines) {
    const Shares shares = layout.shares({one.a, one.b});
    if (shares.empty()) return;
    lines.push_back({layout.start(one.a), layout.start(one.b), Scalar(rest), law});
    elements_.push_back({shares});
  };
  const auto lower_angle = [&](const auto& one, double rest, const auto& law, auto& angles) {
    const Shares shares = layout.shares({one.a, one.b, one.c, one.d});
    if (shares.empty()) return;
    angles.push_back({layout.start(one.a), layout.start(one.b), layout.start(one.c),
                      layout.start(one.d), layout.start(one.axis), Scalar(rest), law});
    elements_.push_back({shares});
  };
  const auto straight = [](const auto& spring) {
    return StraightLaw{Scalar(spring.stiffness), Scalar(spring.damping)};
  };
  const auto curved = [&](const Law& law) {
    driven_ = driven_ || !law.factor.is_constant();
    return CurvedLaw{law};
  };
  for (const Spring& one : model.springs()) lower_line(one, one.length, straight(one), springs_);
  for (const TorsionSpring& one : model.torsion_springs()) {
    lower_angle(one, one.angle, straight(one), torsion_springs_);
  }
  for (const ForceLaw& one : model.force_laws()) lower_line(one, 0, curved(one.law), force_laws_);
  for (const TorqueLaw& one : model.torque_laws()) {
    lower_angle(one, 0, curved(one.law), torque_laws_);
  }
}

template <typename Scalar>
void Forces<Scalar>::lower_couples(const Model& model, const Layout& layout) {
  for (const Couple& couple : model.couples()) {
    const Shares shares = layout.shares({couple.a, couple.b});
    if (shares.empty()) continue;
    couples_.push_back({shares, layout.start(couple.a), layout.start(couple.b),
                        layout.start(couple.axis), Scalar(couple.torque)});
  }
}

template <typename Scalar>
void Forces<Scalar>::drive(double t) {
  for (Line<CurvedLaw>& line : force_laws_) line.law.drive(t);
  for (Angle<CurvedLaw>& angle : torque_laws_) angle.law.drive(t);
}

template <typename Scalar>
template <int dimension, typename AnyLaw>
void Forces<Scalar>::evaluate_lines(const std::vector<Line<AnyLaw>>& lines, const Scalar* q,
                                    const Scalar* v, Scalar* rhs, Element<Scalar>*& element) const {
  for (const Line<AnyLaw>& line : lines) {
    const Point<dimension, Scalar> d = difference<dimension>(q, line.a, line.b);
    const Scalar L = d.norm();
    const Scalar inverse = L == 0 ? Scalar(0) : 1 / L;
    const Point<dimension, Scalar> e = inverse * d;
    const Scalar rate = e.dot(difference<dimension>(v, line.a, line.b));
    const Pull pull = line.law.at(L - line.rest, rate);
    const Scalar p = std::max(Scalar(0), L == 0 ? pull.stiffness : pull.by_position * inverse);
    element->across = scale_ * p;
    element->along = weight(pull) - scale_ * p;
    element->template apply<dimension>(e, Point<dimension, Scalar>::Zero(),
                                       -scale_ * (pull.by_position + pull.by_rate),
                                       rhs);  // Eqs. (11), (18)
    ++element;
  }
}

template <typename Scalar>
template <int dimension, typename AnyLaw>
void Forces<Scalar>::evaluate_angles(const std::vector<Angle<AnyLaw>>& angles, const Scalar* q,
                                     const Scalar* v, Scalar* rhs,
                                     Element<Scalar>*& element) const {
  for (const Angle<AnyLaw>& angle : angles) {
    const Point<dimension, Scalar> u = difference<dimension>(q, angle.a, angle.b);
    const Point<dimension, Scalar> w = difference<dimension>(q, angle.c, angle.d);
    const Point<dimension, Scalar> zu = turned<dimension>(q, angle.axis, u);
    const Point<dimension, Scalar> zw = turned<dimension>(q, angle.axis, w);
    const Point<dimension, Scalar> g_u = zu / -u.squaredNorm();
    const Point<dimension, Scalar> g_w = zw / w.squaredNorm();
    const Scalar theta = std::atan2(zu.dot(w), u.dot(w));  // z·(u × w) = (z × u)·w
    const Scalar s = std::remainder(theta - angle.rest, 2 * std::numbers::pi_v<Scalar>);
    const Scalar rate = g_u.dot(difference<dimension>(v, angle.a, angle.b)) +
                        g_w.dot(difference<dimension>(v, angle.c, angle.d));
    const Pull pull = angle.law.at(s, rate);
    element->along = weight(pull);
    element->template apply<dimension>(g_u, g_w, -scale_ * (pull.by_position + pull.by_rate),
                                       rhs);  // Eqs. (11), (18)
    ++element;
  }
}

template <typename Scalar>
template <int dimension>
void Forces<Scalar>::evaluate_couples(const Scalar* q, Scalar* rhs) const {
  for (const Torque& couple : couples_) {
    const Point<dimension, Scalar> w = difference<dimension>(q, couple.a, couple.b);
    const Point<dimension, Scalar> force =
        scale_ * couple.torque / w.squaredNorm() * turned<dimension>(q, couple.axis, w);
    for (const Share& share : couple.shares) {
      Eigen::Map<Point<dimension, Scalar>>(rhs + share.start) += Scalar(share.in_u) * force;
    }
  }
}

template <typename Scalar>
template <int dimension>
void Forces<Scalar>::evaluate_all(const Scalar* q, const Scalar* v, Scalar* rhs) {
  Element<Scalar>* element = elements_.data();
  evaluate_lines<dimension>(springs_, q, v, rhs, element);
  evaluate_angles<dimension>(torsion_springs_, q, v, rhs, element);
  evaluate_lines<dimension>(force_laws_, q, v, rhs, element);
  evaluate_angles<dimension>(torque_laws_, q, v, rhs, element);
  evaluate_couples<dimension>(q, rhs);
}

template <typename Scalar>
void Forces<Scalar>::evaluate(const Vector& q, const Vector& v, Vector& rhs) {
  dimension_ == 2 ? evaluate_all<2>(q.data(), v.data(), rhs.data())
                  : evaluate_all<3>(q.data(), v.data(), rhs.data());
}

template <typename Scalar>
template <typename MatrixScalar>
void Forces<Scalar>::add_tangent(Eigen::MatrixX<MatrixScalar>& T) const {
  for (const Element<Scalar>& element : elements_) {  // Eq. (5)
    dimension_ == 2 ? element.template add_tangent<2>(T) : element.template add_tangent<3>(T);
  }
}

template <typename Scalar>
void Forces<Scalar>::add_kept_product(const Vector& x, Vector& y) const {
  for (const Element<Scalar>& element : kept_) {  // Eq. (15)
    dimension_ == 2 ? element.template add_product<2>(x.data(), y.data())
                    : element.template add_product<3>(x.data(), y.data());
  }
}

template class Forces<double>;
template class Forces<float>;
template void Forces<double>::add_tangent(Eigen::MatrixX<double>&) const;
template void Forces<double>::add_tangent(Eigen::MatrixX<float>&) const;
template void Forces<float>::add_tangent(Eigen::MatrixX<float>&) const;

}  // namespace mbs::eigen_dense
