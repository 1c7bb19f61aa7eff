// C and K of the last evaluation: their entries in T and their products in Eq. (6).
#include "forces.hpp"

namespace mbs::starting_sparse {

void Forces::assemble(double* entries) const {
  for (const SpringElement& spring : springs_) {
    const auto& sign = spring.ends.sign;
    const double extra = spring.along - spring.across;
    for_each_entry(spring.ends.count, [&](int s, int i, int r, int j) {
      const double across = i == j ? spring.across : 0.0;
      const double along = extra * spring.direction[i] * spring.direction[j];
      *entries++ = sign[s] * sign[r] * (across + along);  // Eq. (5)
    });
  }
  for (const TorsionElement& torsion : torsions_) {
    for_each_entry(torsion.count, [&](int s, int i, int r, int j) {
      *entries++ = torsion.weight * torsion.gradient[s][i] * torsion.gradient[r][j];  // Eq. (5)
    });
  }
}

void Forces::add_product(const double* x, double* y) const {
  for (const SpringElement& spring : springs_) {
    Vector d{};
    double along_e = 0.0;
    for (int axis = 0; axis < dimension_; ++axis) {
      for (int s = 0; s < spring.ends.count; ++s) {
        d[axis] += spring.ends.sign[s] * x[spring.ends.column[s] + axis];
      }
      along_e += spring.direction[axis] * d[axis];
    }
    const double factor = (spring.along - spring.across) * along_e;
    for (int axis = 0; axis < dimension_; ++axis) {
      const double value = spring.across * d[axis] + factor * spring.direction[axis];
      for (int s = 0; s < spring.ends.count; ++s) {
        y[spring.ends.column[s] + axis] += spring.ends.sign[s] * value;
      }
    }
  }
  for (const TorsionElement& torsion : torsions_) {
    double sum = 0.0;
    for (int s = 0; s < torsion.count; ++s) {
      for (int axis = 0; axis < dimension_; ++axis) {
        sum += torsion.gradient[s][axis] * x[torsion.column[s] + axis];
      }
    }
    for (int s = 0; s < torsion.count; ++s) {
      for (int axis = 0; axis < dimension_; ++axis) {
        y[torsion.column[s] + axis] += torsion.weight * sum * torsion.gradient[s][axis];
      }
    }
  }
}

}  // namespace mbs::starting_sparse
