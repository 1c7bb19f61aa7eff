// What a model may have beyond the paper's: planar points, distances between them, a mass matrix and gravity.
#pragma once

#include <initializer_list>

namespace mbs {

/// A kind of term in the equations. The harness refuses a scene that has one which a variant does
/// not list, by the term's name; so none has to be known to whoever does not serve it.
enum class Term {
  dots,              ///< DotConstraint that is no distance
  bilinear,          ///< BilinearConstraint
  linear,            ///< LinearConstraint
  springs,           ///< Spring
  torsion_springs,   ///< TorsionSpring
  dampers,           ///< damping of a Spring or TorsionSpring, Law::by_rate
  couples,           ///< Couple
  force_laws,        ///< ForceLaw, TorqueLaw
  drivers,           ///< DrivenPoint, DrivenValue, DrivenMass, a Law::factor that is not constant
  mass_across_axes,  ///< mass between different axes (x of one point, y of another)
  spatial,           ///< three dimensions
};

/// A set of terms: Terms{Term::springs, Term::dampers}.
class Terms {
 public:
  constexpr Terms() = default;
  constexpr Terms(std::initializer_list<Term> terms) {
    for (const Term term : terms) bits_ |= bit(term);
  }

  [[nodiscard]] constexpr bool has(Term term) const { return (bits_ & bit(term)) != 0; }
  [[nodiscard]] constexpr Terms with(Term term) const {
    Terms more = *this;
    more.bits_ |= bit(term);
    return more;
  }

 private:
  static constexpr unsigned bit(Term term) { return 1u << static_cast<unsigned>(term); }

  unsigned bits_ = 0;
};

}  // namespace mbs
