// What the processor that is compiled for holds in a register.
#pragma once

namespace mbs::compiled_ldl {

/// Doubles of a register. In wider vectors compilers reach a number through memory.
#if defined(__AVX512F__)
inline constexpr int kRegisterDoubles = 8;
#elif defined(__AVX__)
inline constexpr int kRegisterDoubles = 4;
#else
inline constexpr int kRegisterDoubles = 2;
#endif

}  // namespace mbs::compiled_ldl
