// Springs, torsion springs and couples: their part of Q and, matrix-free, of C and K.
#include "forces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace mbs::eigen_dense {

namespace {

template <int dimension>
using Vector = Eigen::Matrix<double, dimension, 1>;

/// z × x, where z starts at `axis` in the extended position q; planar: z = (0, 0, 1).
template <int dimension>
Vector<dimension> turned(const double* q, Eigen::Index axis, const Vector<dimension>& x) {
  if constexpr (dimension == 2) {
    return {-x.y(), x.x()};
  } else {
    return Eigen::Map<const Vector<3>>(q + axis).cross(x);
  }
}

}  // namespace

Forces::Forces(const Model& model, const StepSettings& settings, const Layout& layout)
    : dimension_(layout.dimension()),
      half_step_(settings.step / 2),
      scale_(settings.step * settings.step / 4) {
  lower_springs(model, layout);
  lower_torsion_springs(model, layout);
  lower_couples(model, layout);
}

double Forces::weight(double stiffness, double damping) const {
  return half_step_ * damping + scale_ * stiffness;
}

void Forces::lower_springs(const Model& model, const Layout& layout) {
  for (const Spring& spring : model.springs()) {
    const Shares shares = layout.shares({spring.a, spring.b});
    if (shares.empty()) continue;
    springs_.push_back({layout.start(spring.a), layout.start(spring.b), spring.stiffness,
                        spring.damping, spring.length});
    elements_.push_back({shares, weight(spring.stiffness, spring.damping)});
  }
}

void Forces::lower_torsion_springs(const Model& model, const Layout& layout) {
  for (const TorsionSpring& spring : model.torsion_springs()) {
    const Shares shares = layout.shares({spring.a, spring.b, spring.c, spring.d});
    if (shares.empty()) continue;
    torsion_springs_.push_back({layout.start(spring.a), layout.start(spring.b),
                                layout.start(spring.c), layout.start(spring.d),
                                layout.start(spring.axis), spring.stiffness, spring.damping,
                                spring.angle});
    elements_.push_back({shares, weight(spring.stiffness, spring.damping)});
  }
}

void Forces::lower_couples(const Model& model, const Layout& layout) {
  for (const Couple& couple : model.couples()) {
    const Shares shares = layout.shares({couple.a, couple.b});
    if (shares.empty()) continue;
    couples_.push_back({shares, layout.start(couple.a), layout.start(couple.b),
                        layout.start(couple.axis), couple.torque});
  }
}

template <int dimension>
void Forces::evaluate_springs(const double* q, const double* v, double* rhs) {
  Element* element = elements_.data();
  for (const LinearSpring& spring : springs_) {
    const Vector<dimension> d = difference<dimension>(q, spring.a, spring.b);
    const double L = d.norm();
    const double inverse = L == 0.0 ? 0.0 : 1.0 / L;
    const Vector<dimension> e = inverse * d;
    const double rate = e.dot(difference<dimension>(v, spring.a, spring.b));
    const double p = std::max(0.0, spring.stiffness * (1.0 - spring.length * inverse));
    element->across = scale_ * p;
    element->along = element->weight - scale_ * p;
    const double tension = spring.stiffness * (L - spring.length) + spring.damping * rate;
    element->apply<dimension>(e, Vector<dimension>::Zero(), -scale_ * tension, rhs);  // Eq. (11)
    ++element;
  }
}

template <int dimension>
void Forces::evaluate_torsion_springs(const double* q, const double* v, double* rhs) {
  Element* element = elements_.data() + springs_.size();
  for (const AngularSpring& spring : torsion_springs_) {
    const Vector<dimension> u = difference<dimension>(q, spring.a, spring.b);
    const Vector<dimension> w = difference<dimension>(q, spring.c, spring.d);
    const Vector<dimension> zu = turned<dimension>(q, spring.axis, u);
    const Vector<dimension> zw = turned<dimension>(q, spring.axis, w);
    const Vector<dimension> g_u = zu / -u.squaredNorm();
    const Vector<dimension> g_w = zw / w.squaredNorm();
    const double theta = std::atan2(zu.dot(w), u.dot(w));  // z·(u × w) = (z × u)·w
    const double s = std::remainder(theta - spring.angle, 2.0 * std::numbers::pi);
    const double rate = g_u.dot(difference<dimension>(v, spring.a, spring.b)) +
                        g_w.dot(difference<dimension>(v, spring.c, spring.d));
    const double torque = spring.stiffness * s + spring.damping * rate;
    element->apply<dimension>(g_u, g_w, -scale_ * torque, rhs);  // Eq. (11)
    ++element;
  }
}

template <int dimension>
void Forces::evaluate_couples(const double* q, double* rhs) const {
  for (const Torque& couple : couples_) {
    const Vector<dimension> w = difference<dimension>(q, couple.a, couple.b);
    const Vector<dimension> force =
        scale_ * couple.torque / w.squaredNorm() * turned<dimension>(q, couple.axis, w);
    for (const Share& share : couple.shares) {
      Eigen::Map<Vector<dimension>>(rhs + share.start) += share.in_u * force;
    }
  }
}

template <int dimension>
void Forces::evaluate_all(const double* q, const double* v, double* rhs) {
  evaluate_springs<dimension>(q, v, rhs);
  evaluate_torsion_springs<dimension>(q, v, rhs);
  evaluate_couples<dimension>(q, rhs);
}

void Forces::evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& rhs) {
  dimension_ == 2 ? evaluate_all<2>(q.data(), v.data(), rhs.data())
                  : evaluate_all<3>(q.data(), v.data(), rhs.data());
}

void Forces::add_tangent(Eigen::MatrixXd& T) const {
  for (const Element& element : elements_) {  // Eq. (5)
    dimension_ == 2 ? element.add_tangent<2>(T) : element.add_tangent<3>(T);
  }
}

void Forces::add_product(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  for (const Element& element : elements_) {  // Eq. (6)
    dimension_ == 2 ? element.add_product<2>(x.data(), y.data())
                    : element.add_product<3>(x.data(), y.data());
  }
}

}  // namespace mbs::eigen_dense
