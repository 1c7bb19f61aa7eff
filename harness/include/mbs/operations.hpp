// The three operations of the paper's Table 2, each alone, for timing them apart from a step.
#pragma once

#include <span>

#include "mbs/model.hpp"

namespace mbs {

/// What Table 2 of the paper times with and without symbolic preprocessing: evaluation of the
/// Jacobian, rank-k update and matrix addition, each with the data structures of the
/// implementation's own step and split where the step fuses them. Construction
/// (mbs::Variant::operations) does all set-up work; the three operations are called over and over
/// and each overwrites its previous result.
///
/// The harness checks all three results against its own before it times anything. With
/// n = variables() and m = constraints() of the model:
class Operations {
 public:
  Operations() = default;
  virtual ~Operations() = default;
  Operations(const Operations&) = delete;
  Operations& operator=(const Operations&) = delete;

  /// Takes the coordinates q (n, m) that the Jacobian is evaluated at.
  virtual void set_coordinates(std::span<const double> q) = 0;

  /// Phi_q (m x n) at these coordinates.
  virtual void evaluate_jacobian() = 0;
  /// Phi_q^T Phi_q (n x n) of the last Jacobian.
  virtual void rank_update() = 0;
  /// M + factor Phi_q^T Phi_q (n x n) of the last rank update, into a matrix of its own.
  virtual void add_mass(double factor) = 0;

  /// The last results, dense and row by row, both halves of a symmetric one; never timed.
  virtual void get_jacobian(std::span<double> dense) const = 0;     ///< m x n
  virtual void get_rank_update(std::span<double> dense) const = 0;  ///< n x n
  virtual void get_sum(std::span<double> dense) const = 0;          ///< n x n
};

}  // namespace mbs
