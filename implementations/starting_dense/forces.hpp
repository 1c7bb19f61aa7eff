// Springs, torsion springs and couples: their part of Q, and C and K without storage of their own.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "layout.hpp"
#include "matrix.hpp"
#include "mbs/model.hpp"
#include "vector3.hpp"

namespace mbs::starting_dense {

/// Eq. (11), element by element. With n variables; q and v are extended (see Layout).
///
///   forces.evaluate(q, v);        // at the beginning of a pass; the others use these values
///   forces.subtract_from(right);
///   forces.add_to(tangent);
class Forces {
 public:
  /// `step` is Delta t, s.
  Forces(const Model& model, const Layout& layout, double step);

  /// Evaluates every element at q and v.
  void evaluate(const Vector& q, const Vector& v);
  /// right (n) -= what the elements add to Q.
  void subtract_from(Vector& right) const;
  /// tangent (n x n) += dt/2 C + dt^2/4 K.
  void add_to(Matrix& tangent) const;

 private:
  /// One free point of an element, its shares in the differences (see Share), and the gradient g of
  /// the element's s there. Between the ends i and j of a spring G is p ab_i ab_j (I - e e^T), that
  /// is p ab_i ab_j I - p g_i g_j^T, so that p lessens the factor of g g^T.
  struct End {
    int at;
    double ab, cd;
    Vector3 g;
  };
  struct Element {
    double k = 0.0, c = 0.0;  ///< stiffness and damping
    double rest = 0.0;        ///< s_0
    int axis = -1;            ///< of torsion springs and couples, in extended coordinates
    double force = 0.0;       ///< what Q loses is force g
    double rank_one = 0.0;    ///< factor of g g^T in dt/2 C + dt^2/4 K
    double isotropic = 0.0;   ///< dt^2/4 p, factor of I among the ends of a spring
    std::array<int, 4> at{};  ///< a, b, c, d in extended coordinates
    int ends_begin = 0, ends_end = 0;
  };

  void add_element(const Layout& layout, const std::array<int, 4>& points, Element element);
  void evaluate_spring(Element& spring, const Vector& q, const Vector& v);
  void evaluate_torsion(Element& torsion, const Vector& q, const Vector& v);
  void evaluate_couple(const Element& couple, const Vector& q);
  void set_gradient(const Element& element, const Vector3& by_ab, const Vector3& by_cd);
  void add_block(const Element& element, const End& row, const End& col, Matrix& tangent) const;

  const int dimension_;
  const double half_step_;         ///< dt / 2
  const double quarter_;           ///< dt^2 / 4
  std::vector<Element> elements_;  ///< springs, then torsion springs, then couples
  std::size_t springs_end_ = 0;    ///< in elements_
  std::size_t torsions_end_ = 0;   ///< in elements_; couples have no part in C and K
  std::vector<End> ends_;          ///< of all elements, one element after another
};

}  // namespace mbs::starting_dense
