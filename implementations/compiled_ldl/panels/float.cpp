// Panels in float.
#include "panels/kernels.hpp"
#include "panels/tables.hpp"
#include "panels/wide_kernels.hpp"

namespace mbs::compiled_ldl {

template class Panels<float>;

}  // namespace mbs::compiled_ldl
