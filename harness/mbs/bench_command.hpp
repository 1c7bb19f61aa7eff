// The subcommand `mbs bench`.
#pragma once

namespace mbs {

/// Times variants over stretches of scenes with Google Benchmark; argv[0] is "mbs bench". Takes
/// Google Benchmark's own flags too. Returns 1 if cells failed; their rows say why. Throws
/// UsageError for what the user can mend.
int bench_command(int argc, char** argv);

}  // namespace mbs
