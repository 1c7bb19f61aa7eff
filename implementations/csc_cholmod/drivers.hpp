// Known functions of time: driven points and values, and what they add to Eq. (6) and to Q.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "coordinates.hpp"
#include "lowering.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::csc_cholmod {

/// A row of Phi that depends on time through points or through its value s.
struct DrivenRow {
  int row = 0;
  bool moves = false;          ///< with a driven point: u . B w = s
  std::array<int, 4> point{};  ///< a, b, c, d
  const Matrix* B = nullptr;
  double rate = 0.0;          ///< (dt/2) s'
  double acceleration = 0.0;  ///< (dt^2/4) s''
};

/// Samples of one instant, scaled as velocities and accelerations are everywhere here. A model
/// without drivers has an empty one.
class Drivers {
 public:
  /// `model` and `coordinates` must outlive this. `force`: (dt^2/4) times the constant part of Q.
  Drivers(const Model& model, const StepSettings& settings, const Coordinates& coordinates,
          const LoweredConstraints& lowered, const std::vector<double>& force);

  [[nodiscard]] bool empty() const { return points_.empty() && values_.empty(); }
  /// Samples at time t: positions into q and velocities into u (all places), values into target
  /// (rows), and what driven mass gives into force (n).
  void drive(double t, double* q, double* u, double* target, double* force);

  [[nodiscard]] std::span<const DrivenRow> rows() const { return rows_; }
  /// (dt/2) Phi_t of a row at q (all places).
  [[nodiscard]] double rate(const DrivenRow& row, const double* q) const {
    return terms(row, q, rates_) - row.rate;
  }
  /// (dt^2/4) times what accelerations of drivers alone give of Phi-double-dot.
  [[nodiscard]] double acceleration(const DrivenRow& row, const double* q) const {
    return terms(row, q, accelerations_) - row.acceleration;
  }

 private:
  struct Value {
    int driven_row = 0;
    const TimeFunction* function = nullptr;
  };
  struct Mass {
    int place = 0;
    int source = 0;  ///< in accelerations_
    double value = 0.0;
    double force = 0.0;  ///< the constant part
  };
  void add_rows(const Model& model, const LoweredConstraints& lowered);
  void add_mass(const Model& model, const std::vector<double>& force);
  [[nodiscard]] double terms(const DrivenRow& row, const double* q,
                             const std::vector<double>& motion) const;

  const Coordinates& coordinates_;
  double half_;     ///< dt/2, s
  double quarter_;  ///< dt^2/4, s^2
  std::span<const DrivenPoint> points_;
  std::vector<Value> values_;
  std::vector<DrivenRow> rows_;
  std::vector<Mass> mass_;
  // Of all places behind the unknowns; zero but for driven points.
  std::vector<double> rates_;          ///< (dt/2) velocity, m
  std::vector<double> accelerations_;  ///< (dt^2/4) acceleration, m
};

}  // namespace mbs::csc_cholmod
