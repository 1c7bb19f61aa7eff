// Points eliminated once, in the plane and in space.
#include "schur.hpp"

namespace mbs::compiled_ldl {

template class Schur<2>;
template class Schur<3>;

}  // namespace mbs::compiled_ldl
