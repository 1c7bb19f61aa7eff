// The command line of an engine's program, the loop that is timed, and the line of JSON.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "engine.hpp"
#include "environment/kept_memory.hpp"
#include "judge.hpp"

namespace engines {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

struct Options {
  int loops = 0, repeats = 1;
  bool pendulum = false, as_json = false;
  std::string scene;
  double duration = 5.0;
  std::vector<std::string> settings;
};

/// Times at which the points were seen, and where they were.
struct Samples {
  std::vector<double> t;
  std::vector<std::vector<double>> points;  // x0, y0, x1, ... of each time
};

struct Run {
  double reached = 0.0;
  std::vector<double> seconds;  // of each advance(); with repeats the least
  Samples samples;
};

std::string first_complaint;
long complaints = 0;

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

json finite_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

/// At most 300 characters of `text`, each run of white space a blank.
std::string in_a_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!blank || (!line.empty() && line.back() != ' ')) line += blank ? ' ' : c;
  }
  return line.substr(0, 300);
}

std::vector<double> points_of(const Mechanism& mechanism, const std::vector<RodState>& states) {
  std::vector<double> points;
  for (std::size_t i = 0; i < static_cast<std::size_t>(mechanism.points); ++i) {
    const double half = mechanism.rods[i].length / 2;
    points.push_back(states[i].x + half * states[i].cosine);
    points.push_back(states[i].y + half * states[i].sine);
  }
  return points;
}

/// Advances once, and says in how many seconds.
double timed_advance(Engine& engine, double duration, double& reached) {
  const auto begin = Clock::now();
  reached = engine.advance(duration);
  return seconds(Clock::now() - begin);
}

/// Advances to the end or until the motion is lost. Only advance() is timed: states are read and
/// judged while the clock stands still.
void simulate(Engine& engine, const Mechanism& mechanism, double duration, Judge& judge, Run& run) {
  std::vector<RodState> states(mechanism.rods.size());
  std::vector<double> points;
  while (run.reached < duration) {
    run.seconds.push_back(timed_advance(engine, duration, run.reached));
    if (states.empty()) {
      engine.read_points(points);
      if (!judge.judge_points(points)) return;
    } else {
      engine.read(states);
      if (!judge.judge(run.reached, states)) return;
      points = points_of(mechanism, states);
    }
    if (mechanism.four_bar_loops > 0) continue;  // the judge knows its motion
    run.samples.t.push_back(run.reached);
    run.samples.points.push_back(points);
  }
  judge.conclude();
}

/// The same motion again, unread, for the least time of each advance(): what the machine interrupts
/// in one run it hardly does in the next.
void repeat(Engine& engine, double duration, Run& run) {
  double reached = 0.0;
  for (double& least : run.seconds) {
    least = std::min(least, timed_advance(engine, duration, reached));
  }
}

bool finished(const Judge& judge) { return judge.status() == "ok" || judge.status() == "degraded"; }

json report(const Program& program, const Options& options, const Mechanism& mechanism,
            const Judge& judge, const Run& run) {
  json settings = json::object();
  for (const std::string& word : options.settings)
    settings[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
  const double seconds = std::accumulate(run.seconds.begin(), run.seconds.end(), 0.0);
  json line{{"engine", program.engine},
            {"version", program.version},
            {"setting", settings},
            {"scene", mechanism.scene},
            {"loops", options.loops},
            {"duration", options.duration},
            {"status", judge.status()},
            {"status_reason", judge.reason()},
            {"failed_at", finished(judge) ? json(nullptr) : json(run.reached)},
            {"position_error_max",
             judge.position_error() ? finite_or_null(*judge.position_error()) : json(nullptr)},
            {"energy_drift_max", finite_or_null(judge.energy_drift())},
            {"joint_gap_max", finite_or_null(judge.gap())},
            {"judged", run.seconds.size()},
            {"repeats", options.repeats},
            {"seconds", seconds},
            {"time", run.reached > 0.0 ? json(seconds / run.reached) : json(nullptr)},
            {"complaints", complaints},
            {"first_complaint", first_complaint},
            {"compiler", "GCC " __VERSION__}};
  if (mechanism.four_bar_loops == 0)
    line["outputs"] = {{"t", run.samples.t}, {"points", run.samples.points}};
  return line;
}

int run_it(const Program& program, const Options& options) {
  const Mechanism mechanism = options.pendulum    ? double_pendulum()
                              : options.loops > 0 ? four_bar(options.loops)
                                                  : Mechanism{.scene = options.scene};
  Settings settings(options.settings);
  Judge judge(mechanism);
  Run run;
  try {
    const auto engine = program.create(mechanism, settings, options.duration);
    settings.require_all_taken();
    simulate(*engine, mechanism, options.duration, judge, run);
    for (int again = 1; again < options.repeats && finished(judge); ++again) {
      repeat(*program.create(mechanism, settings, options.duration), options.duration, run);
    }
  } catch (const UsageError&) {
    throw;
  } catch (const std::exception& error) {
    judge.lose("diverged", "the engine gave up: " + in_a_line(error.what()));
  }
  const json line = report(program, options, mechanism, judge, run);
  if (options.as_json) {
    std::cout << line.dump() << '\n';
  } else {
    for (const char* key : {"status", "status_reason", "position_error_max", "energy_drift_max",
                            "joint_gap_max", "time", "first_complaint"})
      std::cout << key << ": " << line[key].dump() << '\n';
  }
  return finished(judge) ? 0 : 1;
}

}  // namespace

void note_complaint(const std::string& text) {
  if (complaints++ == 0) first_complaint = in_a_line(text);
}

int run_program(const Program& program, int argc, char** argv) {
  mbs::keep_memory();
  CLI::App app{program.engine + " " + program.version +
               ": the N-four-bar mechanism or the double pendulum"};
  Options options;
  auto* loops =
      app.add_option("--loops", options.loops, "N of the N-four-bar")->check(CLI::Range(1, 10000));
  auto* pendulum =
      app.add_flag("--pendulum", options.pendulum, "the double pendulum instead")->excludes(loops);
  if (program.takes_scenes) {
    app.add_option("--scene", options.scene, "a scene in the plane, of the harness, instead")
        ->excludes(loops)
        ->excludes(pendulum);
  }
  app.add_option("--duration", options.duration, "simulated time, s")->check(CLI::Range(1e-3, 1e4));
  app.add_option("--repeats", options.repeats,
                 "simulate R times; of each advance to a judged time the least counts")
      ->check(CLI::Range(1, 1000));
  app.add_option("--setting", options.settings, "KEY=VALUE ... (study/engines/README.md)");
  app.add_flag("--json", options.as_json, "one line of JSON");
  try {
    app.parse(argc, argv);
    if (options.loops == 0 && !options.pendulum && options.scene.empty())
      throw UsageError(program.takes_scenes ? "--loops, --pendulum or --scene is required"
                                            : "--loops or --pendulum is required");
    return run_it(program, options);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return 0;
  } catch (const CLI::ParseError& error) {
    std::cerr << "engine_" << program.engine << ": " << error.what() << '\n';
  } catch (const UsageError& error) {
    std::cerr << "engine_" << program.engine << ": " << error.what() << '\n';
  }
  return 2;
}

}  // namespace engines
