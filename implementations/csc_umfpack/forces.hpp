// Springs, torsion springs and couples: their share of the residual and of T.
#pragma once

#include <span>
#include <vector>

#include "coupling.hpp"
#include "force_layout.hpp"
#include "mbs/model.hpp"
#include "vectors.hpp"

namespace mbs::csc_umfpack {

/// What the elements evaluate to and where it goes. C and K are never stored: with an element's
/// gradient g, (Delta t / 2) C + (Delta t^2 / 4) K is `weight` g g^T plus, for springs, a
/// transverse part. The values of the last evaluate() hold until the next.
template <int D>
class Forces {
 public:
  /// `step` is Delta t.
  Forces(const Model& model, const PointLayout& points, double step);

  [[nodiscard]] const ForceLayout& layout() const { return layout_; }

  /// y (n) += (Delta t^2 / 4) (Q - force() - driven mass), Eq. (11), at x and v laid out alike.
  void evaluate(const double* x, const double* v, double* y);
  /// T += (Delta t / 2) C + (Delta t^2 / 4) K, into the places that element_places() gave.
  void add_tangent(const std::vector<Place<D>>& places, double* T) const;

 private:
  struct SpringValues {
    Vector<D> e;                       ///< direction from b to a
    double along = 0.0, across = 0.0;  ///< its blocks are +-(along e e^T + across I)
  };

  void evaluate_springs(const double* x, const double* v, double* y);
  void evaluate_torsion_springs(const double* x, const double* v, double* y);
  void add_couples(const double* x, double* y) const;
  [[nodiscard]] double weight(const auto& element) const {
    return half_ * element.damping + quarter_ * element.stiffness;  // Eqs. (5), (11)
  }
  [[nodiscard]] std::span<const PointLayout::Signs> ends(const auto& element) const {
    return std::span(layout_.ends).subspan(element.first, element.last - element.first);
  }

  ForceLayout layout_;
  double half_;     ///< Delta t / 2, s
  double quarter_;  ///< Delta t^2 / 4, s^2
  std::vector<SpringValues> springs_;
  std::vector<Vector<D>> gradients_;  ///< of torsion springs, at their ends
};

}  // namespace mbs::csc_umfpack
