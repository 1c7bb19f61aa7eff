// Springs, torsion springs and couples: their part of Q and, matrix-free, of C and K.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "element.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::eigen_dense {

/// Evaluates Eq. (11). W = (Δt/2) C + (Δt²/4) K stays in the elements, see Element.
template <typename Scalar>
class Forces {
 public:
  using Vector = Eigen::VectorX<Scalar>;

  Forces(const Model& model, const StepSettings& settings, const Layout& layout);

  /// Whether the model has no such force; all other methods are then without effect.
  [[nodiscard]] bool empty() const { return elements_.empty() && couples_.empty(); }
  /// Whether it has a W, that is springs or torsion springs.
  [[nodiscard]] bool has_tangent() const { return !elements_.empty(); }

  /// At the extended q and v: adds (Δt²/4) times their part of Q to rhs (n), keeps W.
  void evaluate(const Vector& q, const Vector& v, Vector& rhs);

  /// Adds the last W to the lower triangle of T (n×n); the other half is scratch.
  template <typename MatrixScalar>
  void add_tangent(Eigen::MatrixX<MatrixScalar>& T) const;

  /// y (n) += the last W times x, of which the first n elements are read.
  void add_product(const Vector& x, Vector& y) const { add_product(elements_, x, y); }

  /// Keeps the last W for add_kept_product() apart from what evaluate() overwrites.
  void keep() { kept_ = elements_; }
  /// y (n) += the kept W times x (n).
  void add_kept_product(const Vector& x, Vector& y) const { add_product(kept_, x, y); }

 private:
  using Index = Eigen::Index;

  struct LinearSpring {
    Index a, b;
    Scalar stiffness, damping, length;
  };
  struct AngularSpring {
    Index a, b, c, d, axis;
    Scalar stiffness, damping, angle;
  };
  struct Torque {
    Shares shares;
    Index a, b, axis;
    Scalar torque;
  };

  void add_product(const std::vector<Element<Scalar>>& elements, const Vector& x, Vector& y) const;
  void lower_springs(const Model& model, const Layout& layout);
  void lower_torsion_springs(const Model& model, const Layout& layout);
  void lower_couples(const Model& model, const Layout& layout);
  [[nodiscard]] Scalar weight(Scalar stiffness, Scalar damping) const;
  template <int dimension>
  void evaluate_springs(const Scalar* q, const Scalar* v, Scalar* rhs);
  template <int dimension>
  void evaluate_torsion_springs(const Scalar* q, const Scalar* v, Scalar* rhs);
  template <int dimension>
  void evaluate_couples(const Scalar* q, Scalar* rhs) const;
  template <int dimension>
  void evaluate_all(const Scalar* q, const Scalar* v, Scalar* rhs);

  int dimension_;
  Scalar half_step_;  ///< Δt/2, s
  Scalar scale_;      ///< Δt²/4, s²
  std::vector<LinearSpring> springs_;
  std::vector<AngularSpring> torsion_springs_;
  std::vector<Element<Scalar>> elements_;  ///< one a spring, then one a torsion spring
  std::vector<Element<Scalar>> kept_;      ///< those of the last keep()
  std::vector<Torque> couples_;
};

}  // namespace mbs::eigen_dense
