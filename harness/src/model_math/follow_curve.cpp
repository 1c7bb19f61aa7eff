// Predictor along the tangent, Newton back in the plane across it, both by dense LU.
#include "model_math/follow_curve.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "model_math/kinematics.hpp"

namespace mbs {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr double kExactCrossing = 3e-9;  // |Phi| over length^2 between two branches that meet
constexpr double kCrossingWidth = 5e-3;  // of a length: cubics between points are exact to 1e-11
constexpr double kLeastStep = 1e-9;      // of a length
constexpr double kBend = 0.98;           // cosine of the largest angle of two tangents
constexpr int kMostSteps = 4000;

/// Products of determinants of many short links underflow.
bool have_same_sign(double a, double b) { return (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0); }

/// The part's equations in x = (its coordinates, then, if driven, t times a speed).
class PartCurve {
 public:
  PartCurve(const Model& model, const ConstraintBlock& part,
            const std::vector<ConstraintBlock>& blocks, const CurveEnd& from)
      : model_(model),
        part_(part),
        blocks_(blocks),
        q_(*from.q),
        rest_(q_.size(), 0.0),
        t_(from.t),
        phi_(static_cast<std::size_t>(model.constraints())),
        row_(phi_.size(), -1),
        col_(q_.size(), -1) {
    for (std::size_t i = 0; i < part.rows.size(); ++i) row_[at(part.rows[i])] = static_cast<int>(i);
    for (std::size_t i = 0; i < part.cols.size(); ++i) col_[at(part.cols[i])] = static_cast<int>(i);
    for (const int col : part.cols) speed_ += std::pow((*from.v)[at(col)], 2);
    speed_ = std::max(std::sqrt(speed_), 1e-12);
  }

  [[nodiscard]] bool is_driven() const { return !blocks_.empty(); }
  [[nodiscard]] Eigen::Index size() const {
    return static_cast<Eigen::Index>(part_.cols.size()) + (is_driven() ? 1 : 0);
  }
  [[nodiscard]] double time_per_length() const { return 1.0 / speed_; }

  [[nodiscard]] Vector coordinates(const CurveEnd& end) const {
    Vector x = take(*end.q);
    if (is_driven()) x[size() - 1] = speed_ * (end.t - t_);
    return x;
  }
  [[nodiscard]] Vector direction(const CurveEnd& end) const {
    Vector x = take(*end.v);
    if (is_driven()) x[size() - 1] = speed_;
    return x;
  }

  /// Takes time and the coordinates of other parts from between the two.
  void move(const CurveEnd& from, const CurveEnd& to, double share) {
    t_ = std::lerp(from.t, to.t, share);
    for (std::size_t i = 0; i < q_.size(); ++i) q_[i] = std::lerp((*from.q)[i], (*to.q)[i], share);
  }
  /// All coordinates with those of the part.
  [[nodiscard]] std::vector<double> all(const Vector& x) const {
    std::vector<double> q = q_;
    for (std::size_t i = 0; i < part_.cols.size(); ++i) {
      q[at(part_.cols[i])] = x[static_cast<Eigen::Index>(i)];
    }
    return q;
  }

  /// Phi of the rows and its derivative by x.
  void evaluate(const Vector& x, Vector& phi, Matrix& J) {
    for (std::size_t i = 0; i < part_.cols.size(); ++i) {
      q_[at(part_.cols[i])] = x[static_cast<Eigen::Index>(i)];
    }
    const double t = is_driven() ? t_ + x[size() - 1] / speed_ : t_;
    evaluate_constraints(model_, t, q_, phi_);
    phi = rows_of(phi_);
    J.setZero(phi.size(), size());
    for (const JacobianEntry& entry : jacobian(model_, t, q_)) {
      const int row = row_[at(entry.row)], col = col_[at(entry.col)];
      if (row >= 0 && col >= 0) J(row, col) += entry.value;
    }
    if (!is_driven()) return;
    constraint_rate(model_, t, q_, rest_, phi_);
    J.col(size() - 1) = rows_of(phi_) / speed_;
  }

  /// The determinants whose signs stay: of the blocks, or of J above its tangent.
  [[nodiscard]] Vector determinants(const Matrix& J, const Vector& tangent) const {
    if (!is_driven()) {
      Matrix square(size(), size());
      square << J, tangent.transpose();
      return Vector::Constant(1, square.determinant());
    }
    Vector result(static_cast<Eigen::Index>(blocks_.size()));
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const ConstraintBlock& block = blocks_[b];
      const auto k = static_cast<Eigen::Index>(block.rows.size());
      Matrix square(k, k);
      for (Eigen::Index i = 0; i < k; ++i) {
        for (Eigen::Index j = 0; j < k; ++j) {
          square(i, j) = J(row_[at(block.rows[static_cast<std::size_t>(i)])],
                           col_[at(block.cols[static_cast<std::size_t>(j)])]);
        }
      }
      result[static_cast<Eigen::Index>(b)] = square.determinant();
    }
    return result;
  }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }
  [[nodiscard]] Vector take(const std::vector<double>& values) const {
    Vector x = Vector::Zero(size());
    for (std::size_t i = 0; i < part_.cols.size(); ++i) {
      x[static_cast<Eigen::Index>(i)] = values[at(part_.cols[i])];
    }
    return x;
  }
  [[nodiscard]] Vector rows_of(const std::vector<double>& values) const {
    Vector result(static_cast<Eigen::Index>(part_.rows.size()));
    for (std::size_t i = 0; i < part_.rows.size(); ++i) {
      result[static_cast<Eigen::Index>(i)] = values[at(part_.rows[i])];
    }
    return result;
  }

  const Model& model_;
  const ConstraintBlock& part_;
  const std::vector<ConstraintBlock>& blocks_;
  std::vector<double> q_, rest_;
  double t_;
  double speed_ = 0.0;  // m/s
  std::vector<double> phi_;
  std::vector<int> row_, col_;  // place in the part, -1: not in it
};

class Follower {
 public:
  Follower(PartCurve& curve, double length) : curve_(curve), length_(length) {}

  struct Place {
    Vector x, tangent, determinants;
  };

  /// The point of the curve in the plane through x across `border`. None if Newton does not get
  /// there, or if the tangent is not unique.
  std::optional<Place> find(Vector x, const Vector& border) {
    constexpr int kMostPasses = 8;
    for (int pass = 0; pass < kMostPasses; ++pass) {
      curve_.evaluate(x, phi_, J_);
      Matrix square(curve_.size(), curve_.size());
      square << J_, border.transpose();
      const Eigen::PartialPivLU<Matrix> lu(square);
      Vector right = Vector::Zero(curve_.size());
      right.head(phi_.size()) = -phi_;
      const Vector dx = lu.solve(right);
      if (!dx.allFinite()) return std::nullopt;
      x += dx;
      if (dx.cwiseAbs().maxCoeff() > 1e-11 * length_) continue;
      right.setZero();
      right[curve_.size() - 1] = 1.0;
      Vector tangent = lu.solve(right);
      if (!tangent.allFinite()) return std::nullopt;
      tangent.normalize();
      return Place{x, tangent, curve_.determinants(J_, tangent)};
    }
    return std::nullopt;
  }

  /// Whether all that changes its sign between the two does so where two branches meet.
  bool is_crossing(const Place& from, const Place& to) {
    const double chord = (to.x - from.x).norm();
    if (chord < kLeastStep * length_) return true;
    if (chord > kCrossingWidth * length_) return false;
    for (Eigen::Index k = 0; k < from.determinants.size(); ++k) {
      const double a = from.determinants[k], b = to.determinants[k];
      if (have_same_sign(a, b)) continue;
      const double s = a / (a - b);
      const double h00 = (1 + 2 * s) * (1 - s) * (1 - s), h10 = s * (1 - s) * (1 - s);
      const double h01 = s * s * (3 - 2 * s), h11 = s * s * (s - 1);
      const Vector between =
          h00 * from.x + h01 * to.x + chord * (h10 * from.tangent + h11 * to.tangent);
      curve_.evaluate(between, phi_, J_);
      if (!(phi_.cwiseAbs().maxCoeff() <= kExactCrossing * length_ * length_)) return false;
    }
    return true;
  }

  enum class Advance { done, too_long, crossing };
  /// Whether `to` may be the next place.
  Advance judge(const Place& from, const Place& to, double ds) {
    if ((to.x - from.x).norm() > 1.5 * ds) return Advance::too_long;
    if (from.tangent.dot(to.tangent) < kBend) return Advance::too_long;
    const bool is_same = std::equal(from.determinants.begin(), from.determinants.end(),
                                    to.determinants.begin(), have_same_sign);
    if (is_same) return Advance::done;
    return is_crossing(from, to) ? Advance::crossing : Advance::too_long;
  }

 private:
  PartCurve& curve_;
  double length_;
  Vector phi_;
  Matrix J_;
};

double largest(const Vector& x, const Vector& y, Eigen::Index size) {
  return (x - y).head(size).cwiseAbs().maxCoeff();
}

/// One way along the curve. `direction`: of x.
FollowedCurve follow(PartCurve& curve, const CurveEnd& from, const CurveEnd& to, double sign,
                     double length, double tolerance) {
  FollowedCurve result;
  result.distance = std::numeric_limits<double>::infinity();
  result.least_time = std::numeric_limits<double>::infinity();
  Follower follower(curve, length);
  const Vector target = curve.coordinates(to);
  const Eigen::Index last = curve.size() - 1;
  const Eigen::Index points = curve.is_driven() ? last : curve.size();
  auto place = follower.find(curve.coordinates(from), sign * curve.direction(from).normalized());
  if (!place) return result;
  const double reach = 3 * (target - place->x).norm() + 0.1 * length;
  double ds = std::min(0.1 * length, reach), gone = 0.0;
  bool has_missed = false;  // the foot of the target, which is not on this curve
  for (int step = 0; step < kMostSteps; ++step) {
    if (curve.is_driven() && !(place->tangent[last] > 0.0)) return result;
    const double left = curve.is_driven() ? (target[last] - place->x[last]) / place->tangent[last]
                                          : (target - place->x).dot(place->tangent);
    const bool lands = left >= (has_missed ? kLeastStep * length : 0.0) && left <= ds;
    const double now = lands ? left : ds;
    Vector border = place->tangent;
    if (lands && curve.is_driven()) border = Vector::Unit(curve.size(), last);
    Vector ahead = place->x + now * place->tangent;
    if (lands && curve.is_driven()) ahead[last] = target[last];
    const auto next = follower.find(ahead, border);
    const auto advance = next ? follower.judge(*place, *next, std::max(now, 1e-9 * length))
                              : Follower::Advance::too_long;
    if (advance == Follower::Advance::too_long) {
      ds = now / 2;
      if (ds < kLeastStep * length / 8) return result;
      continue;
    }
    if (advance == Follower::Advance::crossing) result.crossed = true;
    if (curve.is_driven()) {
      if (!lands) {
        result.least_time =
            std::min(result.least_time, (next->x[last] - place->x[last]) * curve.time_per_length());
      }
      if (lands) {
        result.distance = largest(next->x, target, points);
        result.end = result.distance <= tolerance ? FollowedCurve::End::reached
                                                  : FollowedCurve::End::elsewhere;
        return result;
      }
    } else if (lands) {
      has_missed = true;
      result.distance = std::min(result.distance, largest(next->x, target, points));
      if (result.distance <= tolerance) {
        result.end = FollowedCurve::End::reached;
        return result;
      }
    }
    gone += now;
    place = next;
    ds = lands ? ds : 1.5 * ds;
    ds = std::min(ds, 0.1 * length);
    if (!curve.is_driven() && gone > reach) {
      result.end = FollowedCurve::End::elsewhere;
      return result;
    }
  }
  return result;
}

}  // namespace

FollowedCurve follow_curve(const Model& model, const ConstraintBlock& part,
                           const std::vector<ConstraintBlock>& blocks, const CurveEnd& from,
                           const CurveEnd& to, double length, double tolerance) {
  PartCurve curve(model, part, blocks, from);
  const FollowedCurve onward = follow(curve, from, to, 1.0, length, tolerance);
  if (curve.is_driven() || onward.end == FollowedCurve::End::reached) return onward;
  const FollowedCurve back =
      follow(curve, from, to, -1.0, length, tolerance);  // it may have turned
  return back.end == FollowedCurve::End::reached ? back : onward;
}

std::optional<std::vector<double>> carry_along(const Model& model, const ConstraintBlock& part,
                                               const CurveEnd& from, const CurveEnd& to,
                                               double length) {
  constexpr double kFirst = 0.25, kLeast = 1e-5;  // of the time
  const std::vector<ConstraintBlock> none;
  PartCurve curve(model, part, none, from);
  Follower follower(curve, length);
  auto place = follower.find(curve.coordinates(from), curve.direction(from).normalized());
  double done = 0.0, now = kFirst;
  while (place && done < 1.0) {
    const double share = std::min(1.0, done + now);
    curve.move(from, to, share);
    const auto next = follower.find(place->x, place->tangent);
    if (!next || place->tangent.dot(next->tangent) < kBend ||
        !have_same_sign(next->determinants[0], place->determinants[0])) {
      now /= 2;
      if (now < kLeast) return std::nullopt;
      continue;
    }
    place = next;
    done = share;
    now = std::min(kFirst, 2 * now);
  }
  if (!place) return std::nullopt;
  return curve.all(place->x);
}

}  // namespace mbs
