// Bilinear constraints: Phi, Phi_q and the derivative of Eq. (7).
#include "assembly.hpp"

namespace mbs::starting_sparse {

template <int kDimension>
void Assembly::evaluate_bilinears(const double* q) {
  double* jacobian = jacobian_.data();
  for (const Bilinear& bilinear : bilinears_) {
    const Dot& at = bilinear.at;
    double product = 0.0;
    for (int place : {at.to_a, at.to_b, at.to_c, at.to_d}) {
      for (int axis = 0; axis < kDimension; ++axis) jacobian[place + axis] = 0.0;
    }
    for (int i = 0; i < kDimension; ++i) {
      const double u = q[at.a + i] - q[at.b + i];
      double Bw = 0.0, Bt_u = 0.0;
      for (int j = 0; j < kDimension; ++j) {
        Bw += bilinear.B[i][j] * (q[at.c + j] - q[at.d + j]);
        Bt_u += bilinear.B[j][i] * (q[at.a + j] - q[at.b + j]);
      }
      product += u * Bw;
      jacobian[at.to_a + i] += Bw;
      jacobian[at.to_b + i] -= Bw;
      jacobian[at.to_c + i] += Bt_u;
      jacobian[at.to_d + i] -= Bt_u;
    }
    phi_[at.row] = product - value_[at.row];  // Eq. (7)
  }
}

/// multiplier_ = 2 u' . B w'.
template <int kDimension>
void Assembly::evaluate_bilinear_derivative(const double* v) {
  for (const Bilinear& bilinear : bilinears_) {
    const Dot& at = bilinear.at;
    double product = 0.0;
    for (int i = 0; i < kDimension; ++i) {
      double Bw = 0.0;
      for (int j = 0; j < kDimension; ++j) {
        Bw += bilinear.B[i][j] * (v[at.c + j] - v[at.d + j]);
      }
      product += (v[at.a + i] - v[at.b + i]) * Bw;
    }
    multiplier_[at.row] = 2.0 * product;
  }
}

template void Assembly::evaluate_bilinears<2>(const double* q);
template void Assembly::evaluate_bilinears<3>(const double* q);
template void Assembly::evaluate_bilinear_derivative<2>(const double* v);
template void Assembly::evaluate_bilinear_derivative<3>(const double* v);

}  // namespace mbs::starting_sparse
