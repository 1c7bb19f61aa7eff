// Panels in double: eight pivots, and wide fronts.
#include "panels/kernels.hpp"
#include "panels/wide_kernels.hpp"

namespace mbs::compiled_ldl {

template void Panels<double>::choose_kernels<8>(Run& run, const FrontShape& shape) const;
template void Panels<double>::set_wide_kernels<1>(Run& run) const;
template void Panels<double>::set_wide_kernels<2>(Run& run) const;
template void Panels<double>::set_wide_kernels<3>(Run& run) const;
template void Panels<double>::set_wide_kernels<4>(Run& run) const;
template void Panels<double>::set_wide_kernels<5>(Run& run) const;
template void Panels<double>::set_wide_kernels<6>(Run& run) const;
template void Panels<double>::set_wide_kernels<7>(Run& run) const;
template void Panels<double>::set_wide_kernels<8>(Run& run) const;

}  // namespace mbs::compiled_ldl
