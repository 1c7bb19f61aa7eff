// Equations of motion of a planar scene as a solver of differential-algebraic equations wants them:
// flat lists of scalar terms, with all their derivatives. Symbols and units: paper/README.md.
#pragma once

#include <cstddef>
#include <vector>

#include "mbs/model.hpp"
#include "sparse_writer.hpp"

namespace engines {

/// Where a block of a matrix begins.
struct Corner {
  std::size_t row, column;
};

/// Vectors are *extended*: behind the n entries of the coordinates come those of the fixed points,
/// two each (their velocities and accelerations are zero), so that no term has to ask what is
/// fixed. That makes size() entries; what is summed up for fixed points is not read.
class Equations {
 public:
  /// Throws UsageError on what mechanisms of points, rods, bodies, springs and couples in the plane
  /// do not have: three dimensions, dampers, torsion springs, laws, drivers.
  explicit Equations(const mbs::Model& model);

  [[nodiscard]] std::size_t n() const { return n_; }
  [[nodiscard]] std::size_t m() const { return values_.size(); }
  [[nodiscard]] std::size_t size() const { return start_.size(); }
  /// Coordinates at the start, m, extended.
  [[nodiscard]] const std::vector<double>& start() const { return start_; }

  // q, v, a and sum are extended; phi, lambda and the like have m() entries.

  /// Phi (m^2; linear rows: m), its rate Phi_q v, and Phi_q a + (Phi_q)' v.
  void constraints(const double* q, const double* v, const double* a, double* phi, double* rate,
                   double* acceleration) const;
  /// sum += Phi_q^T lambda.
  void add_reaction(const double* q, const double* lambda, double* sum) const;
  /// sum += M a - Q, N.
  void add_inertia_and_force(const double* q, const double* a, double* sum) const;

  // Blocks of a matrix, at `at`. The order of their entries is always the same.

  /// factor M.
  void write_mass(double factor, Corner at, SparseWriter& to) const;
  /// Phi_q, scaled; `transposed`: its transpose.
  void write_jacobian(const double* q, double factor, Corner at, SparseWriter& to,
                      bool transposed = false) const;
  /// The derivative of Phi_q x by q, scaled: Phi_q with x for q, without its linear rows.
  void write_jacobian_change(const double* x, double factor, Corner at, SparseWriter& to) const;
  /// The derivative of Phi_q^T lambda by q.
  void write_reaction_change(const double* lambda, Corner at, SparseWriter& to) const;
  /// -dQ/dq.
  void write_stiffness(const double* q, Corner at, SparseWriter& to) const;

 private:
  /// Phi[row] += coefficient (q[a] - q[b]) (q[c] - q[d]).
  struct Product {
    std::size_t row;
    double coefficient;
    std::size_t a, b, c, d;
  };
  /// Phi[row] += coefficient q[column]; of M its entry there.
  struct Entry {
    std::size_t row, column;
    double coefficient;
  };
  /// On the line between two points, of which `a` and `b` are the x; y is the next.
  struct Element {
    std::size_t a, b;
    double strength;      ///< N/m of a spring, N m of a couple
    double length = 0.0;  ///< m, of a spring without force
  };

  void take_constraints(const mbs::Model& model, const std::vector<std::size_t>& places);
  void take_forces(const mbs::Model& model, const std::vector<std::size_t>& places);
  void write(std::size_t row, std::size_t column, double value, Corner at, SparseWriter& to) const {
    if (column < n_) to.add(at.row + row, at.column + column, value);
  }

  std::size_t n_;
  std::vector<double> start_, gravity_;
  std::vector<double> values_;  // of the constraints
  std::vector<Product> products_;
  std::vector<Entry> linear_, mass_;  // both triangles of M
  std::vector<Element> springs_, couples_;
};

}  // namespace engines
