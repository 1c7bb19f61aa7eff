// Springs, laws and couples: their part of Q and, matrix-free, of C and K.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "element.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::eigen_dense {

/// Evaluates Eqs. (11) and (18). W = (Δt/2) C + (Δt²/4) K stays in the elements, see Element.
template <typename Scalar>
class Forces {
 public:
  using Vector = Eigen::VectorX<Scalar>;

  Forces(const Model& model, const StepSettings& settings, const Layout& layout);

  /// Whether the model has no such force; all other methods are then without effect.
  [[nodiscard]] bool empty() const { return elements_.empty() && couples_.empty(); }
  /// Whether it has a W, that is springs, torsion springs or laws.
  [[nodiscard]] bool has_tangent() const { return !elements_.empty(); }

  /// Whether drive() has to be called in every step, before all else.
  [[nodiscard]] bool driven() const { return driven_; }
  /// Takes the factors of the laws at time t (s).
  void drive(double t);

  /// At the extended q and v: adds (Δt²/4) times their part of Q to rhs (n), keeps W.
  void evaluate(const Vector& q, const Vector& v, Vector& rhs);

  /// Adds the last W to the lower triangle of T (n×n); the other half is scratch.
  template <typename MatrixScalar>
  void add_tangent(Eigen::MatrixX<MatrixScalar>& T) const;

  /// Keeps the last W for add_kept_product() apart from what evaluate() overwrites.
  void keep() { kept_ = elements_; }
  /// y (n) += the kept W times x (n).
  void add_kept_product(const Vector& x, Vector& y) const;

 private:
  using Index = Eigen::Index;

  /// F by its two parts, and its slopes over s and ṡ.
  struct Pull {
    Scalar by_position, by_rate;
    Scalar stiffness, damping;
  };
  /// k s + c ṡ: a spring's, with s from its rest.
  struct StraightLaw {
    Scalar stiffness, damping;

    [[nodiscard]] Pull at(Scalar s, Scalar rate) const {
      return {stiffness * s, damping * rate, stiffness, damping};
    }
  };
  /// Eq. (18), the curves in double whatever Scalar is: they stay as the model gives them.
  struct CurvedLaw {
    Law law;
    Scalar factor = Scalar(law.factor.at(0).value);  ///< η; for good where it is constant

    void drive(double t) { factor = Scalar(law.factor.at(t).value); }
    [[nodiscard]] Pull at(Scalar s, Scalar rate) const {
      const Curve::Sample kappa = law.by_position.at(s), delta = law.by_rate.at(rate);
      return {factor * Scalar(kappa.value), factor * Scalar(delta.value),
              factor * Scalar(kappa.slope), factor * Scalar(delta.slope)};
    }
  };
  /// A law that acts along a line.
  template <typename AnyLaw>
  struct Line {
    Index a, b;
    Scalar rest;  ///< s₀, m; 0 with a CurvedLaw
    AnyLaw law;
  };
  /// A law that acts about an axis.
  template <typename AnyLaw>
  struct Angle {
    Index a, b, c, d, axis;
    Scalar rest;  ///< s₀, rad; 0 with a CurvedLaw
    AnyLaw law;
  };
  struct Torque {
    Shares shares;
    Index a, b, axis;
    Scalar torque;
  };

  void lower_elements(const Model& model, const Layout& layout);
  void lower_couples(const Model& model, const Layout& layout);
  /// (Δt/2) c + (Δt²/4) k.
  [[nodiscard]] Scalar weight(const Pull& pull) const {
    return half_step_ * pull.damping + scale_ * pull.stiffness;
  }
  /// evaluate_lines() and evaluate_angles() begin with `element` and leave it behind their last.
  template <int dimension, typename AnyLaw>
  void evaluate_lines(const std::vector<Line<AnyLaw>>& lines, const Scalar* q, const Scalar* v,
                      Scalar* rhs, Element<Scalar>*& element) const;
  template <int dimension, typename AnyLaw>
  void evaluate_angles(const std::vector<Angle<AnyLaw>>& angles, const Scalar* q, const Scalar* v,
                       Scalar* rhs, Element<Scalar>*& element) const;
  template <int dimension>
  void evaluate_couples(const Scalar* q, Scalar* rhs) const;
  template <int dimension>
  void evaluate_all(const Scalar* q, const Scalar* v, Scalar* rhs);

  int dimension_;
  Scalar half_step_;  ///< Δt/2, s
  Scalar scale_;      ///< Δt²/4, s²
  bool driven_ = false;
  std::vector<Line<StraightLaw>> springs_;
  std::vector<Angle<StraightLaw>> torsion_springs_;
  std::vector<Line<CurvedLaw>> force_laws_;
  std::vector<Angle<CurvedLaw>> torque_laws_;
  std::vector<Element<Scalar>> elements_;  ///< one for each of these, in this order
  std::vector<Element<Scalar>> kept_;      ///< those of the last keep()
  std::vector<Torque> couples_;
};

}  // namespace mbs::eigen_dense
