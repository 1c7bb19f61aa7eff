// What the symmetric multistep method remembers, Eq. (17): five w and five a.
#pragma once

#include <array>
#include <utility>

#include "panels/vectors.hpp"

namespace mbs::compiled_ldl {

/// Vectors of `rows` numbers, the newest first; they stay where they are, pointers move:
/// w_ has five steps in the places 0 1 2 3 4, begin_step() makes that 4 0 1 2 3, and the sixth is
/// written over the first.
class History {
 public:
  static constexpr int kSteps = 5;
  static constexpr double kB[] = {3331.0 / 2400.0, -73.0 / 300.0, 3133.0 / 1200.0};  // b_0 … b_2

  /// `size` of the rows are in use.
  History(int size, int rows, double step);

  void forget() { known_ = 0; }
  [[nodiscard]] bool is_full() const { return known_ == kSteps; }
  /// The places of a further step: the oldest one's, with what is still in them.
  void begin_step();
  double* w() { return w_[0]; }
  double* a() { return a_[0]; }
  /// A further step: a_n, w_n as predicted; q += w_n.
  void predict(double* q);
  /// v* at the end of the newest step.
  void find_velocity(double* v) const;

 private:
  template <int N>
  void predict_rows(int i, double* q) const;

  int size_, rows_, known_ = 0;
  double step_;
  double b_[3];  // times Δt²
  Array<double> numbers_;
  std::array<double*, kSteps> w_, a_;
};

inline History::History(int size, int rows, double step)
    : size_(size), rows_(rows), step_(step), numbers_(2 * kSteps * rows, 0.0) {
  for (int i = 0; i < 3; ++i) b_[i] = step * step * kB[i];
  for (int j = 0; j < kSteps; ++j) {
    w_[j] = numbers_.data() + j * rows;
    a_[j] = numbers_.data() + (kSteps + j) * rows;
  }
}

inline void History::begin_step() {
  for (auto* x : {&w_, &a_}) {
    for (int j = kSteps - 1; j > 0; --j) std::swap((*x)[j - 1], (*x)[j]);
  }
  if (known_ < kSteps) ++known_;
}

/// N rows from i on; the oldest step is still in the newest one's places.
template <int N>
void History::predict_rows(int i, double* q) const {
  const auto take = [i](const double* x) {
    if constexpr (N == 1) return x[i];
    if constexpr (N != 1) return load<double, N>(x + i);
  };
  const auto put = [i](double* x, const auto& value) {
    if constexpr (N == 1) x[i] = value;
    if constexpr (N != 1) store<double, N>(x + i, value);
  };
  const auto a1 = take(a_[1]), a2 = take(a_[2]), a3 = take(a_[3]), a4 = take(a_[4]);
  const auto a = 5.0 * (a1 - a4) - 10.0 * (a2 - a3) + take(a_[0]);
  const auto old =
      take(w_[0]) + 0.1 * (take(w_[1]) - take(w_[4])) - 0.2 * (take(w_[2]) - take(w_[3]));
  const auto w = old + (b_[0] * (a + a4) + b_[1] * (a1 + a3) + b_[2] * a2);
  put(a_[0], a);
  put(w_[0], w);
  put(q, take(q) + w);
}

inline void History::predict(double* q) {
  begin_step();
  if (size_ <= 16) {  // as in for_each_row()
    for_each_row(size_, rows_, [this, q](int i) { predict_rows<1>(i, q); });
    return;
  }
  for (int i = 0; i < rows_; i += 8) predict_rows<8>(i, q);
}

inline void History::find_velocity(double* v) const {
  static constexpr double kD[] = {475.0 / 288.0, -247.0 / 90.0, 631.0 / 240.0, -58.0 / 45.0,
                                  367.0 / 1440.0};
  for (int i = 0; i < rows_; ++i) {
    double sum = 0.0;
    for (int j = 0; j < kSteps; ++j) sum += kD[j] * a_[j][i];
    v[i] = w_[0][i] / step_ + step_ * sum;
  }
}

}  // namespace mbs::compiled_ldl
