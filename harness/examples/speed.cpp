// What a step costs in a loop of one's own, all inputs set before each: speed SCENE STEP STEPS
// [VARIANT]. speed.py compares.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mbs/stepper.hpp>
#include <string>

namespace {

/// `text` as a number above 0; `what` it is, for messages.
double number(const char* what, const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end != text && *end == '\0' && value > 0.0) return value;
  throw mbs::Refused(std::string(what) + ": found '" + text + "', allowed is a number above 0");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) throw mbs::Refused("speed SCENE STEP STEPS [IMPLEMENTATION]");
  mbs::StepperOptions options{.implementation = argc > 4 ? argv[4] : "auto"};
  options.settings.step = number("STEP", argv[2]);
  mbs::Stepper stepper(mbs::SceneDocument::load(argv[1]), options);
  mbs::Saved start;  // inputs as the scene has them, as `mbs simulate` leaves them
  stepper.save(start);
  const int inputs = static_cast<int>(start.inputs.size());
  for (long left = std::lround(number("STEPS", argv[3])); left > 0; --left) {
    for (int i = 0; i < inputs; ++i) {
      const auto& [value, rate, acceleration] = start.inputs[static_cast<std::size_t>(i)];
      stepper.set_input(i, value, rate, acceleration);
    }
    if (stepper.step().status == mbs::StepStatus::factorization_failed)
      throw std::runtime_error("a step failed");
  }
  std::printf("%s t = %.9g s\n", stepper.implementation().c_str(), stepper.state().t);
} catch (const std::exception& error) {
  return std::fprintf(stderr, "speed: %s\n", error.what()), 1;
}
