// Storage and evaluation: M, Phi, Phi_q and the tangent matrix in compressed sparse columns.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_klu {

/// Pattern of a square matrix in compressed sparse columns, rows ascending within a column.
/// Example, [1 0; 2 3]: column_begin = {0, 2, 3}, row = {0, 1, 1}.
struct Pattern {
  struct Position {
    int row = 0, col = 0;
    bool operator==(const Position&) const = default;
  };

  Pattern() = default;
  /// The pattern of a `columns` x `columns` matrix; `positions` may come unsorted and repeatedly.
  Pattern(int columns, std::vector<Position> positions);

  [[nodiscard]] int columns() const { return static_cast<int>(column_begin.size()) - 1; }
  [[nodiscard]] int entries() const { return static_cast<int>(row.size()); }
  /// Offset of a stored position; a binary search, for set-up only.
  [[nodiscard]] int offset(int row, int col) const;

  std::vector<int> column_begin;  ///< columns + 1
  std::vector<int> row;           ///< entries
};

/// The constant mass matrix M, both triangles, so that column i read as row i gives (M x)_i as one
/// sum. Stored zeros are entries like any other.
class MassMatrix {
 public:
  explicit MassMatrix(const Model& model);

  /// y = M x; both n.
  void multiply(const double* x, double* y) const;
  /// y1 = M x1 and y2 = M x2 in one sweep; all n.
  void multiply(const double* x1, const double* x2, double* y1, double* y2) const;

 private:
  Pattern pattern_;
  std::vector<double> values_;
};

/// Where everything in Phi and Phi_q is, with all searching done. Constraints are reordered:
/// distances, other dot constraints, linear ones. Points live in an extended vector, the n
/// coordinates of q followed by those of the fixed points, so that no loop asks which are fixed.
///
/// Phi_q of the dot constraints is stored by columns: a free point owns `dim` columns, and its
/// blocks (one constraint's `dim` values) are consecutive. Constraints are evaluated one by one,
/// and their values written to recorded blocks. Example, planar, distances A-B (A fixed) and B-C:
/// B owns blocks 0 and 1 (rows 0, 1), C owns block 2 (row 1); 3 is a spare for what A would get.
template <int dim>
struct JacobianPattern {
  struct Distance {
    int a, b;              ///< offsets into the extended vector
    int block_a, block_b;  ///< where its values go, the spare block for a fixed point
    double value;          ///< m^2
  };
  struct Dot {
    int a, b, c, d;  ///< offsets into the extended vector
    double value;    ///< m^2
    int terms_end;   ///< its terms end here and begin where those before end
  };
  /// The block of one free point of a Dot: first (r_c - r_d) + second (r_a - r_b), Eq. (7).
  struct Term {
    int block;
    double first, second;  ///< from -2 to 2: signs, added up where points coincide
  };
  struct Linear {
    double value;   ///< m
    int terms_end;  ///< as in Dot
  };

  explicit JacobianPattern(const Model& model);
  [[nodiscard]] int dots() const { return static_cast<int>(distances.size() + others.size()); }
  [[nodiscard]] int blocks() const { return static_cast<int>(block_row.size()); }
  [[nodiscard]] int points() const { return static_cast<int>(block_begin.size()) - 1; }

  std::vector<int> model_row;             ///< m; position in the model of each constraint here
  std::vector<double> fixed_coordinates;  ///< tail of the extended position vector, m
  std::vector<int> block_begin;           ///< free points + 1; point p owns q[dim p .. dim p + dim)
  std::vector<int> block_row;             ///< constraint of each block
  std::vector<Distance> distances;
  std::vector<Dot> others;
  std::vector<Term> other_terms;
  std::vector<Linear> linears;
  std::vector<LinearConstraint::Term> linear_terms;
};

/// Phi_q in the storage of a JacobianPattern, which has to outlive it.
template <int dim>
class Jacobian {
 public:
  explicit Jacobian(const JacobianPattern<dim>& pattern);

  /// Evaluates Phi (m, written) and Phi_q at the extended positions q.
  void evaluate(const double* q, double* phi);
  /// y (n) -= Phi_q^T z; z is m.
  void subtract_transposed_product(const double* z, double* y) const;
  /// The same for a z (dots()) that is zero for the linear constraints.
  void subtract_transposed_dots(const double* z, double* y) const;
  /// z (dots(), m^2/s^2) = factor Phi-dot_q v at the extended velocities v.
  void velocity_term(const double* v, double factor, double* z) const;

  [[nodiscard]] const double* block(int k) const { return values_.data() + dim * k; }

 private:
  using Vector = std::array<double, dim>;

  /// x_a - x_b, two points given by their offsets into x.
  static Vector difference(const double* x, int a, int b) {
    Vector d;
    for (int k = 0; k < dim; ++k) d[k] = x[a + k] - x[b + k];
    return d;
  }
  static double dot(const Vector& x, const Vector& y) {
    double sum = 0.0;
    for (int k = 0; k < dim; ++k) sum += x[k] * y[k];
    return sum;
  }

  const JacobianPattern<dim>& pattern_;
  std::vector<double> values_;  ///< dim values a block, and the spare block
};

/// The union pattern of M and Phi_q^T Phi_q, and the schedule that updates Phi_q^T Phi_q: for every
/// dim x dim block of it which Jacobian blocks to multiply and where the values go.
template <int dim>
struct TangentPattern {
  /// Block (p, p): the sum over the point's own, consecutive Jacobian blocks.
  struct Diagonal {
    int begin, end;                ///< Jacobian blocks
    std::array<int, dim> columns;  ///< offset of the first row of each of its columns
  };
  /// Blocks (p, q), p < q, and (q, p), its transpose: one product of two Jacobian blocks.
  struct Coupling {
    int left, right;             ///< Jacobian blocks of p and q, of the same constraint
    std::array<int, dim> above;  ///< columns of (p, q)
    std::array<int, dim> below;  ///< columns of (q, p)
  };

  TangentPattern(const Model& model, const JacobianPattern<dim>& jacobian);

  Pattern pattern;
  std::vector<Diagonal> diagonals;
  std::vector<Coupling> couplings;          ///< the first product for each pair of points
  std::vector<Coupling> further_couplings;  ///< more products for pairs that have them
};

/// The tangent matrix T of Eq. (5), both triangles.
template <int dim>
class Tangent {
 public:
  /// T = M + factor Phi_q^T Phi_q. `pattern` has to outlive it.
  Tangent(const Model& model, const JacobianPattern<dim>& jacobian,
          const TangentPattern<dim>& pattern, double factor);

  /// Updates the values for a new Phi_q.
  void assemble(const Jacobian<dim>& jacobian);

  [[nodiscard]] const Pattern& pattern() const { return pattern_.pattern; }
  [[nodiscard]] std::span<const double> values() const { return values_; }

 private:
  const TangentPattern<dim>& pattern_;
  double factor_;
  std::vector<double> constant_;  ///< M and the linear constraints, over the union pattern
  std::vector<double> values_;
};

}  // namespace mbs::csc_klu
