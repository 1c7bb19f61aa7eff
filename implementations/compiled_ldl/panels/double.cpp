// Panels in double.
#include "panels/kernels.hpp"
#include "panels/tables.hpp"

namespace mbs::compiled_ldl {

template class Panels<double>;

}  // namespace mbs::compiled_ldl
