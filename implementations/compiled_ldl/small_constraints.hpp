// Small scenes: constraints, Eqs. (7) and (8), each evaluated, assembled and forgotten at once.
#pragma once

#include "blocks.hpp"
#include "small_rows.hpp"

namespace mbs::compiled_ldl {

/// What drivers prescribe: of fixed points, and of values by the constraint's number.
struct Prescribed {
  Array<double> points, values;
};

template <int N, int D>
class SmallConstraints {
 public:
  using Row = SmallRow<N>;
  using Matrix = SmallMatrix<N>;

  SmallConstraints(const Model& model, double alpha, double h);

  /// Φ and Φq at q, then λ += change Φ. With a matrix, it and y get what Eqs. (5) and (3) have of
  /// constraints, and Φq is kept for the projections.
  template <bool kAssembles>
  [[gnu::always_inline]] void evaluate(const double* q, double change, Matrix& matrix, Row& y);
  /// y −= (Δt²/4) α (Φqᵀ Φq x + Φqᵀ t), t = Φt or, if there is v, Φ̇q v + Φ̇t; the first two Φq are
  /// those of the matrix, and x is zero at fixed points.
  void project(const double* x, const double* v, const Prescribed* prescribed, Row& y) const;
  /// What linear rows add to the matrix.
  void add_constant(Matrix& matrix) const {
    for (const Linear& linear : linear_) matrix.add_square(alpha_ * h_, linear.row);
  }

  Array<double> lambda, values;  ///< by number

 private:
  struct Gradient {
    double at_u[D], at_w[D];
    alignas(64) double row[Row::kSize];
  };
  struct Distance {
    Difference<N, D> u;
    int number;
    Gradient of_matrix, last;
  };
  struct Product {
    Difference<N, D> u, w;
    double B[D][D];
    int number;
    Gradient of_matrix, last;
  };
  struct Linear {
    alignas(64) double row[Row::kSize];
    int number, begin, end;
  };
  void add_product(const Model& model, const BilinearConstraint& c, int number);
  /// Given Φ and its gradient.
  template <bool kAssembles>
  [[gnu::always_inline]] void finish(int number, double phi, double change, const Row& gradient,
                                     Row& y);

  double alpha_, h_;
  std::vector<Distance> distances_;
  std::vector<Product> products_;
  std::vector<Linear> linear_;
  std::vector<int> term_rows_;
  std::vector<double> term_coefficients_;
};

}  // namespace mbs::compiled_ldl

#include "small_constraints_evaluate.hpp"
#include "small_constraints_setup.hpp"
