// Panels in double, of up to seven pivots.
#include "panels/kernels.hpp"
#include "panels/tables.hpp"

namespace mbs::compiled_ldl {

// Eight pivots and wide fronts are half of the time to compile: panels/double_wide.cpp.
extern template void Panels<double>::choose_kernels<8>(Run& run, const FrontShape& shape) const;

template class Panels<double>;

}  // namespace mbs::compiled_ldl
