// Known functions of time with two derivatives: what drivers prescribe, factors of laws.
#pragma once

#include <limits>
#include <memory>
#include <utility>

namespace mbs {

/// A twice continuously differentiable function of time. A cheap handle: copies share one immutable
/// function.
class TimeFunction {
 public:
  /// f, f' and f'' at one instant, in the unit of f, per s and per s^2.
  struct Sample {
    double value = 0.0, rate = 0.0, acceleration = 0.0;
  };
  /// What a kind of function implements.
  class Kind {
   public:
    virtual ~Kind() = default;
    [[nodiscard]] virtual Sample at(double t) const = 0;
    /// Last time at which it is known, s: that of a table.
    [[nodiscard]] virtual double end() const { return std::numeric_limits<double>::infinity(); }
  };

  /// A constant.
  TimeFunction(double value = 0.0) : constant_(value) {}  // NOLINT: a number is a function
  explicit TimeFunction(std::shared_ptr<const Kind> kind) : kind_(std::move(kind)) {}

  [[nodiscard]] bool is_constant() const { return kind_ == nullptr; }
  /// At time t, s.
  [[nodiscard]] Sample at(double t) const {
    return kind_ ? kind_->at(t) : Sample{constant_, 0.0, 0.0};
  }
  /// Last time at which it is known, s; infinite unless it is tabulated.
  [[nodiscard]] double end() const {
    return kind_ ? kind_->end() : std::numeric_limits<double>::infinity();
  }

 private:
  double constant_ = 0.0;
  std::shared_ptr<const Kind> kind_;
};

}  // namespace mbs
