// Mass matrices, in double and in float.
#include "elements/mass.hpp"

namespace mbs::compiled_ldl {

template class Mass<double, 2>;
template class Mass<double, 3>;
template class Mass<float, 2>;
template class Mass<float, 3>;

}  // namespace mbs::compiled_ldl
