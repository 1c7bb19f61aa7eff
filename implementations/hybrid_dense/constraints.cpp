#include "constraints.hpp"

#include <algorithm>

namespace mbs::hybrid_dense {

template <int D>
Constraints<D>::Constraints(const Model& model, const Slots& slots) {
  const auto dots = model.dot_constraints();
  const auto bilinear = model.bilinear_constraints();
  const auto linear = model.linear_constraints();
  const auto add_row = [&](int model_row, std::initializer_list<int> points) {
    order_.push_back(model_row);
    first_.push_back(static_cast<int>(slot_.size()));
    for (const int point : points) {
      for (int i = 0; i < D; ++i) slot_.push_back(slots.of[point] + i);
    }
  };
  for (std::size_t k = 0; k < dots.size(); ++k) {
    const auto& [a, b, c, d, value, name] = dots[k];
    if (!dots[k].is_distance()) continue;
    add_row(static_cast<int>(k), {a, b});
    distances_.push_back({slots.of[a], slots.of[b], value});
  }
  for (std::size_t k = 0; k < dots.size(); ++k) {
    const auto& [a, b, c, d, value, name] = dots[k];
    if (dots[k].is_distance()) continue;
    add_row(static_cast<int>(k), {a, b, c, d});
    dots_.push_back({slots.of[a], slots.of[b], slots.of[c], slots.of[d], value});
  }
  for (std::size_t k = 0; k < bilinear.size(); ++k) {
    const BilinearConstraint& row = bilinear[k];
    add_row(static_cast<int>(dots.size() + k), {row.a, row.b, row.c, row.d});
    Bilinear mine{{slots.of[row.a], slots.of[row.b], slots.of[row.c], slots.of[row.d], row.value},
                  {}};
    for (int i = 0; i < D; ++i) std::copy_n(row.B[i].begin(), D, mine.B[i].begin());
    bilinear_.push_back(mine);
  }
  for (std::size_t k = 0; k < linear.size(); ++k) {
    add_row(static_cast<int>(dots.size() + bilinear.size() + k), {});
    const int first = static_cast<int>(slot_.size());
    for (const LinearConstraint::Term& term : linear[k].terms) {
      slot_.push_back(term.coordinate);
      coefficients_.push_back(term.coefficient);
    }
    linear_.push_back({first, static_cast<int>(slot_.size()), linear[k].value});
  }
  first_.push_back(static_cast<int>(slot_.size()));

  // Driven values.
  std::vector<int> row_of(count());  // by row of the model
  for (int k = 0; k < count(); ++k) row_of[order_[k]] = k;
  const auto value_of = [&](int k) -> double* {
    std::size_t index = k;
    if (index < distances_.size()) return &distances_[index].value;
    index -= distances_.size();
    if (index < dots_.size()) return &dots_[index].value;
    index -= dots_.size();
    if (index < bilinear_.size()) return &bilinear_[index].dot.value;
    return &linear_[index - bilinear_.size()].value;
  };
  for (const DrivenValue& driven : model.driven_values()) {
    const int row = row_of[driven.constraint];
    functions_.push_back({row, driven.value, value_of(row), {}});
  }
}

template <int D>
void Constraints<D>::write_constants(double* Phi_q) const {
  if (!linear_.empty()) {
    std::copy(coefficients_.begin(), coefficients_.end(), Phi_q + linear_.front().first);
  }
}

template <int D>
void Constraints<D>::drive(double t) {
  for (Function& function : functions_) {
    function.now = function.value.at(t);
    *function.target = function.now.value;
  }
}

template <int D>
void Constraints<D>::evaluate(const double* q, double* Phi, double* Phi_q) const {
  for (const auto& [a, b, value] : distances_) {
    double sum = 0.0;
    for (int i = 0; i < D; ++i) {
      const double u = q[a + i] - q[b + i];
      sum += u * u;
      Phi_q[i] = 2 * u;
      Phi_q[D + i] = -2 * u;
    }
    *Phi++ = sum - value;
    Phi_q += 2 * D;
  }
  for (const auto& [a, b, c, d, value] : dots_) {
    double sum = 0.0;
    for (int i = 0; i < D; ++i) {
      const double u = q[a + i] - q[b + i], w = q[c + i] - q[d + i];
      sum += u * w;
      Phi_q[i] = w;
      Phi_q[D + i] = -w;
      Phi_q[2 * D + i] = u;
      Phi_q[3 * D + i] = -u;
    }
    *Phi++ = sum - value;
    Phi_q += 4 * D;
  }
  for (const auto& [dot, B] : bilinear_) {
    double u[D], w[D], Bw[D] = {}, Btu[D] = {}, sum = 0.0;
    for (int i = 0; i < D; ++i) {
      u[i] = q[dot.a + i] - q[dot.b + i];
      w[i] = q[dot.c + i] - q[dot.d + i];
    }
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) {
        Bw[i] += B[i][j] * w[j];
        Btu[j] += B[i][j] * u[i];
      }
    }
    for (int i = 0; i < D; ++i) {
      sum += u[i] * Bw[i];
      Phi_q[i] = Bw[i];
      Phi_q[D + i] = -Bw[i];
      Phi_q[2 * D + i] = Btu[i];
      Phi_q[3 * D + i] = -Btu[i];
    }
    *Phi++ = sum - dot.value;
    Phi_q += 4 * D;
  }
  for (const auto& [first, end, value] : linear_) {
    double sum = 0.0;
    for (int e = first; e < end; ++e) sum += *Phi_q++ * q[slot_[e]];
    *Phi++ = sum - value;
  }
}

template <int D>
void Constraints<D>::add_forces(const double* Phi_q, const double* y, double* f) const {
  for (const auto& [a, b, value] : distances_) {
    for (int i = 0; i < D; ++i) {
      const double force = Phi_q[i] * *y;
      f[a + i] += force;
      f[b + i] -= force;
    }
    Phi_q += 2 * D;
    ++y;
  }
  for (std::size_t e = 2 * D * distances_.size(), k = distances_.size(); k + 1 < first_.size();
       ++k) {
    for (; e < static_cast<std::size_t>(first_[k + 1]); ++e) f[slot_[e]] += *Phi_q++ * *y;
    ++y;
  }
}

template <int D>
void Constraints<D>::multiply(const double* Phi_q, const double* x, double* y) const {
  for (const auto& [a, b, value] : distances_) {
    double sum = 0.0;
    for (int i = 0; i < D; ++i) sum += Phi_q[i] * (x[a + i] - x[b + i]);
    *y++ = sum;
    Phi_q += 2 * D;
  }
  for (std::size_t e = 2 * D * distances_.size(), k = distances_.size(); k + 1 < first_.size();
       ++k) {
    double sum = 0.0;
    for (; e < static_cast<std::size_t>(first_[k + 1]); ++e) sum += *Phi_q++ * x[slot_[e]];
    *y++ = sum;
  }
}

template <int D>
void Constraints<D>::first_derivative(const double* Phi_q, const double* v, double* result) const {
  multiply(Phi_q, v, result);
  for (const Function& function : functions_) result[function.row] -= function.now.rate;
}

template <int D>
void Constraints<D>::second_derivative(const double* Phi_q, const double* v,
                                       const double* acceleration, double* result) const {
  multiply(Phi_q, acceleration, result);
  for (const Function& function : functions_) result[function.row] -= function.now.acceleration;
  for (const auto& [a, b, value] : distances_) {
    double sum = 0.0;
    for (int i = 0; i < D; ++i) {
      const double u = v[a + i] - v[b + i];
      sum += u * u;
    }
    *result++ += 2 * sum;
  }
  for (const auto& [a, b, c, d, value] : dots_) {
    double sum = 0.0;
    for (int i = 0; i < D; ++i) sum += (v[a + i] - v[b + i]) * (v[c + i] - v[d + i]);
    *result++ += 2 * sum;
  }
  for (const auto& [dot, B] : bilinear_) {
    double sum = 0.0;
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) {
        sum += (v[dot.a + i] - v[dot.b + i]) * B[i][j] * (v[dot.c + j] - v[dot.d + j]);
      }
    }
    *result++ += 2 * sum;
  }
}

template class Constraints<2>;
template class Constraints<3>;

}  // namespace mbs::hybrid_dense
