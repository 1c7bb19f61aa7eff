// Drivers, in double and in float.
#include "elements/drivers.hpp"

namespace mbs::compiled_ldl {

template class Drivers<double, 2>;
template class Drivers<double, 3>;
template class Drivers<float, 2>;
template class Drivers<float, 3>;

}  // namespace mbs::compiled_ldl
