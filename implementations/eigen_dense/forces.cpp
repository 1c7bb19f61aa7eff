// Springs, torsion springs and couples: their part of Q and, matrix-free, of C and K.
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
  lower_springs(model, layout);
  lower_torsion_springs(model, layout);
  lower_couples(model, layout);
}

template <typename Scalar>
Scalar Forces<Scalar>::weight(Scalar stiffness, Scalar damping) const {
  return half_step_ * damping + scale_ * stiffness;
}

template <typename Scalar>
void Forces<Scalar>::lower_springs(const Model& model, const Layout& layout) {
  for (const Spring& spring : model.springs()) {
    const Shares shares = layout.shares({spring.a, spring.b});
    if (shares.empty()) continue;
    springs_.push_back({layout.start(spring.a), layout.start(spring.b), Scalar(spring.stiffness),
                        Scalar(spring.damping), Scalar(spring.length)});
    elements_.push_back({shares, weight(springs_.back().stiffness, springs_.back().damping)});
  }
}

template <typename Scalar>
void Forces<Scalar>::lower_torsion_springs(const Model& model, const Layout& layout) {
  for (const TorsionSpring& spring : model.torsion_springs()) {
    const Shares shares = layout.shares({spring.a, spring.b, spring.c, spring.d});
    if (shares.empty()) continue;
    torsion_springs_.push_back({layout.start(spring.a), layout.start(spring.b),
                                layout.start(spring.c), layout.start(spring.d),
                                layout.start(spring.axis), Scalar(spring.stiffness),
                                Scalar(spring.damping), Scalar(spring.angle)});
    elements_.push_back(
        {shares, weight(torsion_springs_.back().stiffness, torsion_springs_.back().damping)});
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
template <int dimension>
void Forces<Scalar>::evaluate_springs(const Scalar* q, const Scalar* v, Scalar* rhs) {
  Element<Scalar>* element = elements_.data();
  for (const LinearSpring& spring : springs_) {
    const Point<dimension, Scalar> d = difference<dimension>(q, spring.a, spring.b);
    const Scalar L = d.norm();
    const Scalar inverse = L == 0 ? Scalar(0) : 1 / L;
    const Point<dimension, Scalar> e = inverse * d;
    const Scalar rate = e.dot(difference<dimension>(v, spring.a, spring.b));
    const Scalar p = std::max(Scalar(0), spring.stiffness * (1 - spring.length * inverse));
    element->across = scale_ * p;
    element->along = element->weight - scale_ * p;
    const Scalar tension = spring.stiffness * (L - spring.length) + spring.damping * rate;
    element->template apply<dimension>(e, Point<dimension, Scalar>::Zero(), -scale_ * tension,
                                       rhs);  // Eq. (11)
    ++element;
  }
}

template <typename Scalar>
template <int dimension>
void Forces<Scalar>::evaluate_torsion_springs(const Scalar* q, const Scalar* v, Scalar* rhs) {
  Element<Scalar>* element = elements_.data() + springs_.size();
  for (const AngularSpring& spring : torsion_springs_) {
    const Point<dimension, Scalar> u = difference<dimension>(q, spring.a, spring.b);
    const Point<dimension, Scalar> w = difference<dimension>(q, spring.c, spring.d);
    const Point<dimension, Scalar> zu = turned<dimension>(q, spring.axis, u);
    const Point<dimension, Scalar> zw = turned<dimension>(q, spring.axis, w);
    const Point<dimension, Scalar> g_u = zu / -u.squaredNorm();
    const Point<dimension, Scalar> g_w = zw / w.squaredNorm();
    const Scalar theta = std::atan2(zu.dot(w), u.dot(w));  // z·(u × w) = (z × u)·w
    const Scalar s = std::remainder(theta - spring.angle, 2 * std::numbers::pi_v<Scalar>);
    const Scalar rate = g_u.dot(difference<dimension>(v, spring.a, spring.b)) +
                        g_w.dot(difference<dimension>(v, spring.c, spring.d));
    const Scalar torque = spring.stiffness * s + spring.damping * rate;
    element->template apply<dimension>(g_u, g_w, -scale_ * torque, rhs);  // Eq. (11)
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
  evaluate_springs<dimension>(q, v, rhs);
  evaluate_torsion_springs<dimension>(q, v, rhs);
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
void Forces<Scalar>::add_product(const std::vector<Element<Scalar>>& elements, const Vector& x,
                                 Vector& y) const {
  for (const Element<Scalar>& element : elements) {  // Eq. (6)
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
