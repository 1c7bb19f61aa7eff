// Set-up and first looks, warm-up, samples, end.
#include "bench/scene_timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "bench/paired_ratio.hpp"
#include "bench/suspect.hpp"
#include "bench/warm_up.hpp"

namespace mbs {
namespace {

struct Contender {
  ContenderResult* result = nullptr;
  std::unique_ptr<Measurement> measurement;  ///< none after a failure
  std::unique_ptr<WarmUp> warm_up;
  double step_seconds = 0.0, stretch_seconds = 0.0;  ///< as far as known, else 0

  [[nodiscard]] bool in_race() const {
    return result->timed() && !result->cell->control && step_seconds > 0.0;
  }
};

class SceneTiming {
 public:
  SceneTiming(std::span<const PlannedCell> cells, const TimingWishes& wishes, const Watch& watch);
  SceneResult run();

 private:
  template <class Work>
  void attempt(Contender& contender, const Work& work);
  void fail(Contender& contender, std::string why);
  void look(Contender& contender);
  void warm_up(Contender& contender);
  void leave_out_slow();
  void plan();
  void take_samples();
  void end();
  void say(const std::string& what) const {
    if (watch_) watch_(fmt::format("{}: {}", result_.scene->scene.name, what));
  }

  const TimingWishes& wishes_;
  const Watch& watch_;
  SceneResult result_;
  std::vector<Contender> contenders_;
  double fastest_ = std::numeric_limits<double>::infinity();  ///< s a step
};

SceneTiming::SceneTiming(std::span<const PlannedCell> cells, const TimingWishes& wishes,
                         const Watch& watch)
    : wishes_(wishes), watch_(watch), result_{cells.front().scene, {}, 0, {}} {
  for (const PlannedCell& cell : cells) result_.contenders.emplace_back().cell = &cell;
  for (ContenderResult& result : result_.contenders) contenders_.emplace_back().result = &result;
}

/// Does `work` in the contender's name; what it throws is the contender's failure.
template <class Work>
void SceneTiming::attempt(Contender& contender, const Work& work) {
  if (!contender.result->timed()) return;
  name_suspect(contender.result->cell->name);
  try {
    work();
  } catch (...) {
    fail(contender, failure_text());
  }
  name_suspect("");
}

void SceneTiming::fail(Contender& contender, std::string why) {
  contender.result->failure = std::move(why);
  contender.result->samples = {};
  name_suspect(contender.result->cell->name);
  contender.warm_up.reset();
  contender.measurement.reset();
  name_suspect("");
}

void SceneTiming::look(Contender& contender) {
  const PlannedCell& cell = *contender.result->cell;
  const PlannedScene& planned = *cell.scene;
  contender.measurement = std::make_unique<Measurement>(
      MeasurementTask{planned.scene, *cell.variant, planned.stretch, planned.settings, cell.control,
                      wishes_.phases});
  contender.measurement->set_up();
  contender.warm_up =
      std::make_unique<WarmUp>(*contender.measurement, planned.stretch.steps, wishes_.patience);
  if (!wishes_.slower_than) return;
  contender.warm_up->look(*wishes_.slower_than * fastest_);
  contender.step_seconds = contender.warm_up->step_seconds();
  contender.result->look_seconds = contender.step_seconds;
  // What does not compute must not be what others are slower than.
  contender.measurement->require_finite("in the first steps");
}

/// The rest of the first stretch; if that is shorter than a turn, more of them.
void SceneTiming::warm_up(Contender& contender) {
  constexpr double kEnough = 0.02;   // s
  constexpr double kReading = 1e-6;  // s; of the clocks
  contender.warm_up->finish();
  contender.measurement->accept();
  double total = contender.stretch_seconds = contender.warm_up->seconds();
  while (total < std::min(wishes_.slice, kEnough)) {
    contender.measurement->start();
    const double again = contender.measurement->advance(result_.scene->stretch.steps).cpu_seconds;
    contender.stretch_seconds = std::min(contender.stretch_seconds, again);
    total += again + kReading;
  }
  contender.step_seconds = contender.stretch_seconds / result_.scene->stretch.steps;
}

void SceneTiming::leave_out_slow() {
  if (!wishes_.slower_than) return;
  fastest_ = std::numeric_limits<double>::infinity();
  for (const Contender& contender : contenders_) {
    if (contender.in_race()) fastest_ = std::min(fastest_, contender.step_seconds);
  }
  for (Contender& contender : contenders_) {
    if (!contender.in_race() || contender.step_seconds <= *wishes_.slower_than * fastest_) continue;
    fail(contender, fmt::format("slower: at least {:g} times the fastest (first look: {:.4g} µs a "
                                "step)",
                                *wishes_.slower_than, 1e6 * *contender.result->look_seconds));
  }
}

void SceneTiming::plan() {
  std::vector<double> seconds, typical;
  for (const Contender& contender : contenders_) {
    if (!contender.result->timed()) continue;
    seconds.push_back(contender.stretch_seconds);
    if (contender.in_race()) typical.push_back(contender.stretch_seconds);
  }
  std::erase_if(contenders_, [](const Contender& contender) { return !contender.result->timed(); });
  if (seconds.empty()) return;
  if (typical.empty()) typical = seconds;
  // Between the fastest, whose turns must not be lost in those of the others, and the median.
  const double between = std::sqrt(std::ranges::min(typical) * median(typical));
  result_.turns = plan_turns(result_.scene->stretch.steps, seconds, between, wishes_.slice);
  double sample = 0.0;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    sample += seconds[i] * static_cast<double>(result_.turns.repeats[i]);
  }
  result_.samples =
      wishes_.samples > 0
          ? wishes_.samples
          : static_cast<int>(std::clamp<double>(kSceneTime / sample, kLeastSamples, kMostSamples));
}

void SceneTiming::take_samples() {
  RandomOrder random(wishes_.seed);
  for (int j = 1; j <= result_.samples; ++j) {
    say(fmt::format("sample {} of {}", j, result_.samples));
    for (Contender& contender : contenders_) {
      if (contender.result->timed()) contender.result->samples.emplace_back();
    }
    take_turns(result_.turns, random, [this](const Turn& turn) {
      Contender& contender = contenders_[turn.contender];
      attempt(contender, [&] {
        Sample& sample = contender.result->samples.back();
        sample.stretches = turn.repeats;
        for (long i = 0; i < turn.repeats; ++i) {
          if (turn.first == 0) contender.measurement->start();
          sample.spent += contender.measurement->advance(turn.steps);
        }
      });
    });
  }
}

void SceneTiming::end() {
  for (Contender& contender : contenders_) {
    attempt(contender, [&] {
      contender.measurement->require_finite("after a timed stretch");
      contender.result->figures = contender.measurement->figures();
      contender.measurement.reset();
    });
  }
}

SceneResult SceneTiming::run() {
  const auto for_all = [this](const char* what, void (SceneTiming::*work)(Contender&)) {
    for (Contender& contender : contenders_) {
      say(fmt::format("{} {}", what, contender.result->cell->name));
      attempt(contender, [&] { (this->*work)(contender); });
      if (work == &SceneTiming::look) leave_out_slow();
    }
  };
  for_all("set-up of", &SceneTiming::look);
  for_all("warm-up of", &SceneTiming::warm_up);
  leave_out_slow();
  plan();
  take_samples();
  end();
  return std::move(result_);
}

}  // namespace

std::vector<double> ContenderResult::step_times() const {
  std::vector<double> result;
  const double steps = cell->scene->stretch.steps;
  for (const Sample& sample : samples) {
    result.push_back(1e6 * sample.spent.cpu_seconds /
                     (steps * static_cast<double>(sample.stretches)));
  }
  return result;
}

SceneResult time_scene(std::span<const PlannedCell> cells, const TimingWishes& wishes,
                       const Watch& watch) {
  return SceneTiming(cells, wishes, watch).run();
}

}  // namespace mbs
