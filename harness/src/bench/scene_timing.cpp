// Set-up and first looks, warm-up, samples, end.
#include "bench/scene_timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

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
  void narrow();
  void plan();
  void take_samples();
  void end();
  void say(const std::string& what) const {
    if (watch_) watch_(fmt::format("{}: {}", result_.scene->scene.name, what));
  }

  const TimingWishes& wishes_;
  const Watch& watch_;
  SceneResult result_;
  RandomOrder random_;
  std::vector<Contender> contenders_;

  /// What the contender is compared with: 0 or 1.
  [[nodiscard]] std::size_t layer(const Contender& contender) const {
    return wishes_.by_layer && contender.result->cell->own_code ? 1 : 0;
  }
  /// s a step, from which on it is too slow.
  [[nodiscard]] double slow(const Contender& contender) const {
    return slower_than_ * fastest_[layer(contender)];
  }
  [[nodiscard]] std::string slower_text() const {
    return fmt::format("slower: at least {:g} times the fastest{}", slower_than_,
                       wishes_.by_layer ? " of its layer" : "");
  }

  static constexpr double kNever = std::numeric_limits<double>::infinity();
  double slower_than_;                             ///< as wished or narrower; kNever without a wish
  std::array<double, 2> fastest_{kNever, kNever};  ///< s a step, of each layer
};

/// Processor time that no machine's core goes below in a step of a dense variant, s: one Cholesky
/// factorization at 2 x 10^11 operations a second, more than two vector units of 512 bits at 5 GHz.
double least_dense_step(const PlannedScene& planned) {
  if (planned.settings.tangent != TangentReuse::none) return 0.0;
  const double rate = planned.settings.precision == Precision::double_precision ? 2e11 : 4e11;
  return std::pow(planned.scene.model.variables(), 3) / 3 / rate;
}

SceneTiming::SceneTiming(std::span<const PlannedCell> cells, const TimingWishes& wishes,
                         const Watch& watch)
    : wishes_(wishes),
      watch_(watch),
      result_{cells.front().scene, {}, 0, {}},
      random_(wishes.seed),
      slower_than_(wishes.slower_than.value_or(kNever)) {
  for (const PlannedCell& cell : cells) result_.contenders.emplace_back().cell = &cell;
  // Whoever is set up first has other places in memory: another one in each process.
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  shuffle(order, random_);
  for (const std::size_t i : order) contenders_.emplace_back().result = &result_.contenders[i];
  if (!wishes.by_layer) return;
  // The likely fast first.
  std::ranges::stable_sort(contenders_, {}, [](const Contender& contender) {
    const PlannedCell& cell = *contender.result->cell;
    return std::pair(cell.variant->dense, !cell.own_code);
  });
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
  if (wishes_.by_layer && wishes_.slower_than && cell.variant->dense &&
      least_dense_step(planned) > slow(contender)) {
    throw CellFailure(slower_text() + " (by its number of operations)");
  }
  contender.measurement = std::make_unique<Measurement>(
      MeasurementTask{planned.scene, *cell.variant, planned.stretch, planned.settings, cell.control,
                      wishes_.phases});
  contender.measurement->set_up();
  contender.warm_up =
      std::make_unique<WarmUp>(*contender.measurement, planned.stretch.steps, wishes_.patience);
  if (!wishes_.slower_than) return;
  constexpr double kHopeless = 10.0;  // times too slow
  contender.warm_up->look(slow(contender), wishes_.by_layer ? kHopeless * slow(contender) : kNever);
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
  fastest_ = {kNever, kNever};
  for (const Contender& contender : contenders_) {
    double& fastest = fastest_[layer(contender)];
    if (contender.in_race()) fastest = std::min(fastest, contender.step_seconds);
  }
  for (Contender& contender : contenders_) {
    if (!contender.in_race() || contender.step_seconds <= slow(contender)) continue;
    fail(contender, fmt::format("{} (first look: {:.4g} µs a step)", slower_text(),
                                1e6 * *contender.result->look_seconds));
  }
}

/// Until the warm-up and the least number of samples fit, as far as the first looks tell.
void SceneTiming::narrow() {
  if (!wishes_.budget) return;
  for (const double narrower : {5.0, 3.0, 2.0}) {
    double stretch = 0.0;
    for (const Contender& contender : contenders_) {
      if (contender.in_race()) stretch += contender.step_seconds * result_.scene->stretch.steps;
    }
    if (stretch * (1 + kLeastByLayer) <= *wishes_.budget) return;
    slower_than_ = std::min(slower_than_, narrower);
    leave_out_slow();
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
  result_.samples = wishes_.samples > 0
                        ? wishes_.samples
                        : static_cast<int>(std::clamp<double>(
                              kSceneTime / sample, wishes_.by_layer ? kLeastByLayer : kLeastSamples,
                              kMostSamples));
}

void SceneTiming::take_samples() {
  for (int j = 1; j <= result_.samples; ++j) {
    say(fmt::format("sample {} of {}", j, result_.samples));
    for (Contender& contender : contenders_) {
      if (contender.result->timed()) contender.result->samples.emplace_back();
    }
    take_turns(result_.turns, random_, [this](const Turn& turn) {
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
    int count = 0;
    for (Contender& contender : contenders_) {
      say(fmt::format("{} {} of {}, {}", what, ++count, contenders_.size(),
                      contender.result->cell->variant_name()));
      attempt(contender, [&] { (this->*work)(contender); });
      if (work == &SceneTiming::look) leave_out_slow();
    }
  };
  for_all("set-up", &SceneTiming::look);
  narrow();
  for_all("warm-up", &SceneTiming::warm_up);
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
