// The program `mbs` as a function, without the headers that its commands need.
#pragma once

namespace mbs {

/// Parses the command line and runs it; the exit status: 0 done, 1 a result that is not right,
/// 2 bad input.
int run_program(int argc, char** argv);

}  // namespace mbs
