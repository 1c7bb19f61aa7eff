// Mass matrices and drivers, in double and in float.
#include "elements/drivers.hpp"
#include "elements/mass.hpp"

namespace mbs::compiled_ldl {

template class Drivers<double, 2>;
template class Drivers<double, 3>;
template class Drivers<float, 2>;
template class Drivers<float, 3>;

template class Mass<double, 2>;
template class Mass<double, 3>;
template class Mass<float, 2>;
template class Mass<float, 3>;

}  // namespace mbs::compiled_ldl
