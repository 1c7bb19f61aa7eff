// Evaluates u . B w - s, Eq. (7).
#include "bilinear.hpp"

namespace mbs::ublas_sparse {

Triple times(const Matrix3& B, const Triple& w) {
  return {dot(B[0], w), dot(B[1], w), dot(B[2], w)};
}

Triple transposed_times(const Matrix3& B, const Triple& u) {
  Triple result{};
  for (int k = 0; k < 3; ++k) result[k] = B[0][k] * u[0] + B[1][k] * u[1] + B[2][k] * u[2];
  return result;
}

BilinearConstraints::BilinearConstraints(const Model& model, const Points& points, int first_row) {
  int row = first_row;
  for (const BilinearConstraint& constraint : model.bilinear_constraints()) {
    Bilinear bilinear;
    bilinear.row = row++;
    bilinear.a = points.first(constraint.a);
    bilinear.b = points.first(constraint.b);
    bilinear.c = points.first(constraint.c);
    bilinear.d = points.first(constraint.d);
    bilinear.B = constraint.B;
    append_columns(points, bilinear, columns_);
    bilinears_.push_back(bilinear);
  }
}

void BilinearConstraints::append_positions(const Points& points,
                                           std::vector<Entry>& entries) const {
  for (const Bilinear& bilinear : bilinears_) {
    ublas_sparse::append_positions(points, bilinear, columns_, entries);
  }
}

void BilinearConstraints::evaluate(const Points& points, const std::vector<double>& values,
                                   Vector& Phi) const {
  const double* r = points.position();
  for (const Bilinear& bilinear : bilinears_) {
    const Triple u = points.difference(r, bilinear.a, bilinear.b);
    const Triple w = points.difference(r, bilinear.c, bilinear.d);
    Phi(bilinear.row) = dot(u, times(bilinear.B, w)) - values[bilinear.row];  // Eq. (7)
  }
}

void BilinearConstraints::evaluate_jacobian(const Points& points, SparseMatrix& Phi_q) const {
  const double* r = points.position();
  for (const Bilinear& bilinear : bilinears_) {
    const Triple Btu = transposed_times(bilinear.B, points.difference(r, bilinear.a, bilinear.b));
    const Triple Bw = times(bilinear.B, points.difference(r, bilinear.c, bilinear.d));
    for (int p = bilinear.columns_begin; p < bilinear.columns_end; ++p) {
      const Column& column = columns_[p];
      for (int k = 0; k < points.dimension(); ++k) {
        Phi_q(bilinear.row, column.point + k) = column.by_cd * Bw[k] + column.by_ab * Btu[k];
      }
    }
  }
}

void BilinearConstraints::evaluate_acceleration_term(const Points& points, Vector& term) const {
  const double* v = points.velocity();
  for (const Bilinear& bilinear : bilinears_) {
    const Triple u = points.difference(v, bilinear.a, bilinear.b);
    const Triple w = points.difference(v, bilinear.c, bilinear.d);
    term(bilinear.row) = 2.0 * dot(u, times(bilinear.B, w));  // Eq. (7)
  }
}

}  // namespace mbs::ublas_sparse
