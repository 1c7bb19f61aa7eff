#include "forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mbs::hybrid_dense {
namespace {

template <int D>
using Vector = std::array<double, D>;

template <int D>
Vector<D> difference(const double* x, int a, int b) {
  Vector<D> d;
  for (int i = 0; i < D; ++i) d[i] = x[a + i] - x[b + i];
  return d;
}

template <int D>
double dot(const Vector<D>& x, const Vector<D>& y) {
  double sum = 0.0;
  for (int i = 0; i < D; ++i) sum += x[i] * y[i];
  return sum;
}

// z x w; in the plane z is (0, 0, 1).
template <int D>
Vector<D> turned(const double* q, int axis, const Vector<D>& w) {
  if constexpr (D == 2) {
    return {-w[1], w[0]};
  } else {
    const double* z = q + axis;
    return {z[1] * w[2] - z[2] * w[1], z[2] * w[0] - z[0] * w[2], z[0] * w[1] - z[1] * w[0]};
  }
}

// Of Eq. (18) at s and its rate; a spring is the law of two straight lines.
struct Strength {
  double position;            // eta kappa
  double force;               // eta (kappa + delta)
  double stiffness, damping;  // eta kappa', eta delta'
};

template <class Element>
Strength strength(const Element& element, double s, double excess, double rate) {
  if (element.law == nullptr) {
    const double position = element.stiffness * excess;
    return {position, position + element.damping * rate, element.stiffness, element.damping};
  }
  const Curve::Sample kappa = element.law->by_position.at(s), delta = element.law->by_rate.at(rate);
  const double eta = element.factor;
  return {eta * kappa.value, eta * (kappa.value + delta.value), eta * kappa.slope,
          eta * delta.slope};
}

}  // namespace

template <int D>
Forces<D>::Forces(const Model& model, const Slots& slots, double dt) : n_(slots.n), dt_(dt) {
  const auto slot = [&](int point) { return point < 0 ? -1 : slots.of[point]; };
  for (const Spring& s : model.springs()) {
    lines_.push_back({slot(s.a), slot(s.b), s.stiffness, s.damping, s.length, nullptr, 1.0});
  }
  for (const ForceLaw& law : model.force_laws()) {
    lines_.push_back(
        {slot(law.a), slot(law.b), 0.0, 0.0, 0.0, &law.law, law.law.factor.at(0.0).value});
  }
  for (const TorsionSpring& s : model.torsion_springs()) {
    angles_.push_back({slot(s.a), slot(s.b), slot(s.c), slot(s.d), slot(s.axis), s.stiffness,
                       s.damping, s.angle, nullptr, 1.0});
  }
  for (const TorqueLaw& law : model.torque_laws()) {
    angles_.push_back({slot(law.a), slot(law.b), slot(law.c), slot(law.d), slot(law.axis), 0.0, 0.0,
                       0.0, &law.law, law.law.factor.at(0.0).value});
  }
  for (const mbs::Couple& c : model.couples()) {
    couples_.push_back({slot(c.a), slot(c.b), slot(c.axis), c.torque});
  }
  blocks_.resize(lines_.size());
  gradients_.resize(angles_.size());
}

template <int D>
void Forces<D>::drive(double t) {
  const auto set = [t](auto& element) {
    if (element.law != nullptr) element.factor = element.law->factor.at(t).value;
  };
  std::ranges::for_each(lines_, set);
  std::ranges::for_each(angles_, set);
}

template <int D>
void Forces<D>::evaluate(const double* q, const double* v, double* f) {
  const double half = dt_ / 2, quarter = dt_ * dt_ / 4;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const Line& line = lines_[k];
    const Vector<D> d = difference<D>(q, line.a, line.b);
    const double length = std::sqrt(dot<D>(d, d));
    const double inverse = length > 0.0 ? 1.0 / length : 0.0;
    Vector<D> e;
    for (int i = 0; i < D; ++i) e[i] = d[i] * inverse;
    const double rate = dot<D>(e, difference<D>(v, line.a, line.b));
    const Strength now = strength(line, length, length - line.length, rate);
    for (int i = 0; i < D; ++i) {
      f[line.a + i] += now.force * e[i];
      f[line.b + i] -= now.force * e[i];
    }
    // p of the geometric stiffness
    const double p = length > 0.0 ? now.position * inverse : now.stiffness;
    const double across = quarter * std::max(0.0, p);
    const double along = half * now.damping + quarter * now.stiffness - across;
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) {
        blocks_[k].values[i * D + j] = along * e[i] * e[j] + (i == j ? across : 0.0);
      }
    }
  }
  for (std::size_t k = 0; k < angles_.size(); ++k) {
    const Angle& angle = angles_[k];
    const Vector<D> u = difference<D>(q, angle.a, angle.b), w = difference<D>(q, angle.c, angle.d);
    const Vector<D> z_u = turned<D>(q, angle.axis, u), z_w = turned<D>(q, angle.axis, w);
    const double per_u = 1.0 / dot<D>(u, u), per_w = 1.0 / dot<D>(w, w);
    auto& [weight, g] = gradients_[k];
    double rate = 0.0;
    for (int i = 0; i < D; ++i) {
      g[i] = -z_u[i] * per_u;
      g[D + i] = -g[i];
      g[2 * D + i] = z_w[i] * per_w;
      g[3 * D + i] = -g[2 * D + i];
      rate += g[i] * (v[angle.a + i] - v[angle.b + i]) +
              g[2 * D + i] * (v[angle.c + i] - v[angle.d + i]);
    }
    const double theta = std::atan2(dot<D>(z_u, w), dot<D>(u, w));  // z . (u x w) = (z x u) . w
    const double excess = std::remainder(theta - angle.angle, 2 * std::numbers::pi);
    const Strength now = strength(angle, theta, excess, rate);
    for (int i = 0; i < D; ++i) {
      f[angle.a + i] += now.force * g[i];
      f[angle.b + i] += now.force * g[D + i];
      f[angle.c + i] += now.force * g[2 * D + i];
      f[angle.d + i] += now.force * g[3 * D + i];
    }
    weight = half * now.damping + quarter * now.stiffness;
  }
  for (const Couple& couple : couples_) {
    const Vector<D> w = difference<D>(q, couple.a, couple.b);
    const Vector<D> z_w = turned<D>(q, couple.axis, w);
    const double per_w = couple.torque / dot<D>(w, w);
    for (int i = 0; i < D; ++i) {
      f[couple.a + i] -= per_w * z_w[i];
      f[couple.b + i] += per_w * z_w[i];
    }
  }
}

template <int D>
template <class Visit>
void Forces<D>::visit_lines(Visit visit) const {
  const auto is_free = [this](int slot) { return slot < n_; };
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const int a = lines_[k].a, b = lines_[k].b;
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) {
        const int value = static_cast<int>(k * D * D) + i * D + j;
        if (is_free(a) && i >= j) visit(a + i, a + j, value, false);
        if (is_free(b) && i >= j) visit(b + i, b + j, value, false);
        if (is_free(a) && is_free(b))
          visit(std::max(a + i, b + j), std::min(a + i, b + j), value, true);
      }
    }
  }
}

template <int D>
template <class Visit>
void Forces<D>::visit_angles(Visit visit) const {
  for (std::size_t k = 0; k < angles_.size(); ++k) {
    const int points[] = {angles_[k].a, angles_[k].b, angles_[k].c, angles_[k].d};
    for (int left = 0; left < 4 * D; ++left) {
      for (int right = 0; right < 4 * D; ++right) {
        const int row = points[left / D] + left % D, column = points[right / D] + right % D;
        if (row < n_ && row >= column) visit(row, column, static_cast<int>(k), left, right);
      }
    }
  }
}

template <int D>
std::vector<std::pair<int, int>> Forces<D>::tangent_entries() const {
  std::vector<std::pair<int, int>> entries;
  visit_lines([&](int row, int column, int, bool) { entries.emplace_back(row, column); });
  visit_angles([&](int row, int column, int, int, int) { entries.emplace_back(row, column); });
  return entries;
}

template <int D>
void Forces<D>::schedule(const Schedule::Position& position) {
  visit_lines([&](int row, int column, int value, bool negative) {
    (negative ? subtractions_ : additions_).push_back({position(row, column), value});
  });
  visit_angles([&](int row, int column, int angle, int left, int right) {
    products_.push_back({position(row, column), angle, left, right});
  });
}

template <int D>
void Forces<D>::add_tangent(double* T) const {
  const double* values = blocks_.empty() ? nullptr : blocks_[0].values;
  for (const auto& [position, value] : additions_) T[position] += values[value];
  for (const auto& [position, value] : subtractions_) T[position] -= values[value];
  for (const auto& [position, angle, left, right] : products_) {
    const auto& [weight, g] = gradients_[angle];
    T[position] += weight * g[left] * g[right];
  }
}

template class Forces<2>;
template class Forces<3>;

}  // namespace mbs::hybrid_dense
