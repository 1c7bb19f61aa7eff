// Controls that do not come back from their step, or not in an orderly way.
#include "controls/wrong_endings.hpp"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "controls/wrapped_reference.hpp"

namespace mbs::test {
namespace {

class Hangs final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    volatile bool forever = true;
    while (forever) continue;
    return {};
  }
};

class Crashes final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    volatile int* volatile nowhere = nullptr;
    *nowhere = 1;
    return {};
  }
};

class OverflowsStack final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override { return {StepStatus::converged, descend(1)}; }
  static int descend(int depth) {  // NOLINT(misc-no-recursion): that is the defect
    volatile char frame[4096];
    frame[0] = static_cast<char>(depth);
    return depth > 0 ? descend(depth + 1) + frame[0] : 0;
  }
};

class DividesByZero final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    volatile int zero = 0;
    return {StepStatus::converged, 1000 / zero};
  }
};

class Allocates final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    constexpr std::size_t kChunk = std::size_t{16} << 20;
    while (true) {
      chunks_.push_back(std::make_unique<char[]>(kChunk));
      std::memset(chunks_.back().get(), 1, kChunk);
    }
  }
  std::vector<std::unique_ptr<char[]>> chunks_;
};

class Throws final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override { throw std::runtime_error("the pivot\nis \xff nowhere"); }
};

class ThrowsNumber final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override { throw 42; }
};

class Exits final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override { std::_Exit(EXIT_SUCCESS); }
};

class Aborts final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override { std::abort(); }
};

/// Right, but with a second process that comes back too.
class Forks final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    if (!forked_) forked_ = ::fork() >= 0;
    return WrappedReference::do_step();
  }
  bool forked_ = false;
};

/// Right, but noisy on the stream that carries the program's results.
class Prints final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    constexpr char kText[] = "control/prints was here\n";
    if (::write(STDOUT_FILENO, kText, sizeof kText - 1) < 0) std::abort();
    return WrappedReference::do_step();
  }
};

template <class Control>
std::unique_ptr<Simulation> create_ending(const Model& model, const StepSettings& settings) {
  return std::make_unique<Control>(model, settings);
}

std::unique_ptr<Simulation> refuse(const Model&, const StepSettings&) {
  throw Unsupported("only even numbers\nof loops");
}

}  // namespace

std::vector<Variant> wrong_endings() {
  return {
      {"hangs", "step() never returns", create_ending<Hangs>},
      {"crashes", "step() writes to address 0", create_ending<Crashes>},
      {"overflows_stack", "step() calls itself without end", create_ending<OverflowsStack>},
      {"divides_by_zero", "step() divides an integer by zero", create_ending<DividesByZero>},
      {"aborts", "step() calls abort()", create_ending<Aborts>},
      {"allocates", "step() allocates and uses memory without end", create_ending<Allocates>},
      {"throws", "step() throws", create_ending<Throws>},
      {"throws_number", "step() throws what is no std::exception", create_ending<ThrowsNumber>},
      {"exits", "step() ends the process with status 0", create_ending<Exits>},
      {"forks", "right, but a second process comes back too", create_ending<Forks>},
      {"prints", "right, but prints in every step", create_ending<Prints>},
      {"unsupported", "cannot simulate any scene", refuse},
  };
}

}  // namespace mbs::test
