// Each kind with its two derivatives.
#include "scene/time_functions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace mbs {
namespace {

using Sample = TimeFunction::Sample;

template <typename Kind, typename... Arguments>
TimeFunction make(Arguments&&... arguments) {
  return TimeFunction(std::make_shared<const Kind>(std::forward<Arguments>(arguments)...));
}

class Polynomial final : public TimeFunction::Kind {
 public:
  explicit Polynomial(std::vector<double> coefficients) : coefficients_(std::move(coefficients)) {}

  [[nodiscard]] Sample at(double t) const override {  // Horner's rule, derived twice
    Sample sample;
    for (auto c = coefficients_.rbegin(); c != coefficients_.rend(); ++c) {
      sample.acceleration = sample.acceleration * t + 2 * sample.rate;
      sample.rate = sample.rate * t + sample.value;
      sample.value = sample.value * t + *c;
    }
    return sample;
  }

 private:
  std::vector<double> coefficients_;
};

class SineKind final : public TimeFunction::Kind {
 public:
  explicit SineKind(const Sine& sine) : sine_(sine) {}

  [[nodiscard]] Sample at(double t) const override {
    const double omega = 2 * std::numbers::pi * sine_.frequency;
    const double s = sine_.amplitude * std::sin(omega * t + sine_.phase);
    const double c = sine_.amplitude * std::cos(omega * t + sine_.phase);
    return {sine_.offset + s, omega * c, -omega * omega * s};
  }

 private:
  Sine sine_;
};

/// Second derivatives at the rows of the natural cubic spline: a tridiagonal system, solved by
/// elimination (diagonally dominant).
std::vector<double> natural_bends(const std::vector<double>& t, const std::vector<double>& y) {
  const std::size_t rows = t.size();
  std::vector<double> bend(rows, 0.0), above(rows, 0.0);
  for (std::size_t i = 1; i + 1 < rows; ++i) {
    const double before = t[i] - t[i - 1], after = t[i + 1] - t[i];
    const double jump = (y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before;
    const double pivot = 2 * (before + after) - before * above[i - 1];
    above[i] = after / pivot;
    bend[i] = (6 * jump - before * bend[i - 1]) / pivot;
  }
  for (std::size_t i = rows - 1; i-- > 1;) bend[i] -= above[i] * bend[i + 1];
  return bend;
}

class SplineKind final : public TimeFunction::Kind {
 public:
  SplineKind(std::vector<double> times, std::vector<double> values)
      : t_(std::move(times)), y_(std::move(values)), bend_(natural_bends(t_, y_)) {}

  [[nodiscard]] Sample at(double t) const override {
    const auto after = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
    const auto i = static_cast<std::size_t>(after - t_.begin() - 1);
    const double h = t_[i + 1] - t_[i];
    const double from = t - t_[i], to = t_[i + 1] - t;
    const double slope = (y_[i + 1] - y_[i]) / h;
    if (from < 0.0) return straight(y_[i], slope - h / 6 * bend_[i + 1], from);
    if (to < 0.0) return straight(y_[i + 1], slope + h / 6 * bend_[i], -to);
    const double b0 = bend_[i], b1 = bend_[i + 1];
    return {(y_[i] * to + y_[i + 1] * from) / h -
                from * to / 6 * (b0 * (1 + to / h) + b1 * (1 + from / h)),
            slope - b0 * (3 * to * to - h * h) / (6 * h) + b1 * (3 * from * from - h * h) / (6 * h),
            (b0 * to + b1 * from) / h};
  }

  [[nodiscard]] double end() const override { return t_.back(); }

 private:
  static Sample straight(double value, double slope, double along) {
    return {value + slope * along, slope, 0.0};
  }

  std::vector<double> t_, y_, bend_;
};

class InputKind final : public TimeFunction::Kind {
 public:
  explicit InputKind(std::shared_ptr<const Sample> now) : now_(std::move(now)) {}

  [[nodiscard]] Sample at(double /*t*/) const override { return *now_; }

 private:
  std::shared_ptr<const Sample> now_;
};

class PushingKind final : public TimeFunction::Kind {
 public:
  PushingKind(TimeFunction force, double position)
      : force_(std::move(force)), position_(position) {}

  [[nodiscard]] Sample at(double t) const override { return {position_, 0.0, -force_.at(t).value}; }
  [[nodiscard]] double end() const override { return force_.end(); }

 private:
  TimeFunction force_;
  double position_;
};

class SquareKind final : public TimeFunction::Kind {
 public:
  explicit SquareKind(TimeFunction f) : f_(std::move(f)) {}

  [[nodiscard]] Sample at(double t) const override {
    const Sample f = f_.at(t);
    return {f.value * f.value, 2 * f.value * f.rate,
            2 * (f.rate * f.rate + f.value * f.acceleration)};
  }
  [[nodiscard]] double end() const override { return f_.end(); }

 private:
  TimeFunction f_;
};

class CosineKind final : public TimeFunction::Kind {
 public:
  CosineKind(TimeFunction angle, double amplitude, double phase)
      : angle_(std::move(angle)), amplitude_(amplitude), phase_(phase) {}

  [[nodiscard]] Sample at(double t) const override {
    const Sample angle = angle_.at(t);
    const double c = amplitude_ * std::cos(angle.value + phase_);
    const double s = amplitude_ * std::sin(angle.value + phase_);
    return {c, -s * angle.rate, -c * angle.rate * angle.rate - s * angle.acceleration};
  }
  [[nodiscard]] double end() const override { return angle_.end(); }

 private:
  TimeFunction angle_;
  double amplitude_, phase_;
};

class CombinationKind final : public TimeFunction::Kind {
 public:
  CombinationKind(Summands terms, double constant) : terms_(std::move(terms)), constant_(constant) {}

  [[nodiscard]] Sample at(double t) const override {
    Sample sum{constant_, 0.0, 0.0};
    for (const auto& [factor, function] : terms_) {
      const Sample f = function.at(t);
      sum.value += factor * f.value;
      sum.rate += factor * f.rate;
      sum.acceleration += factor * f.acceleration;
    }
    return sum;
  }
  [[nodiscard]] double end() const override {
    double end = std::numeric_limits<double>::infinity();
    for (const auto& [factor, function] : terms_) end = std::min(end, function.end());
    return end;
  }

 private:
  Summands terms_;
  double constant_;
};

}  // namespace

TimeFunction polynomial(std::vector<double> coefficients) {
  return make<Polynomial>(std::move(coefficients));
}

TimeFunction sine(const Sine& sine) { return make<SineKind>(sine); }

TimeFunction spline(std::vector<double> times, std::vector<double> values) {
  return make<SplineKind>(std::move(times), std::move(values));
}

TimeFunction input(std::shared_ptr<const Sample> now) { return make<InputKind>(std::move(now)); }

TimeFunction pushing(TimeFunction force, double position) {
  return make<PushingKind>(std::move(force), position);
}

TimeFunction square_of(TimeFunction f) {
  if (f.is_constant()) return f.at(0.0).value * f.at(0.0).value;
  return make<SquareKind>(std::move(f));
}

TimeFunction cosine_of(TimeFunction angle, double amplitude, double phase) {
  if (angle.is_constant()) return amplitude * std::cos(angle.at(0.0).value + phase);
  return make<CosineKind>(std::move(angle), amplitude, phase);
}

TimeFunction combination(const Summands& terms, double constant) {
  Summands moving;
  for (const auto& [factor, function] : terms) {
    if (function.is_constant()) {
      constant += factor * function.at(0.0).value;
    } else if (factor != 0.0) {
      moving.emplace_back(factor, function);
    }
  }
  if (moving.empty()) return constant;
  return make<CombinationKind>(std::move(moving), constant);
}

}  // namespace mbs
