// What README.md claims of stale pivots, checked against what was measured.
#include "claims.hpp"

#include <functional>
#include <initializer_list>
#include <stdexcept>
#include <string_view>

namespace mbs::stale_pivots {
namespace {

constexpr double kExact = 1e-14;  ///< 20 times and more what good pivots give
constexpr double kFair = 1e-13;   ///< what a threshold of 0.001 may cost
constexpr double kPoor = 1e-9;

/// Rows of a sequence and form, with a strategy and a rule; "" is any.
struct Which {
  std::string_view sequence, form, strategy, pivoting;
};

using Condition = std::function<bool(const Row&)>;

Condition below(double bound) {
  return [=](const Row& row) { return row.error_worst < bound; };
}
Condition above(double bound) {
  return [=](const Row& row) { return row.error_worst > bound; };
}
bool never_repivoted(const Row& row) { return row.repivotings == 0; }
bool has_repivoted(const Row& row) { return row.repivotings > 0; }

class Judge {
 public:
  explicit Judge(const std::vector<Row>& rows) : rows_(rows) {}

  /// All rows of all of `which` meet the condition; there has to be one of each.
  void expect(const char* text, std::initializer_list<Which> which, const Condition& condition) {
    bool holds = true;
    for (const Which& some : which) {
      int found = 0;
      for (const Row& row : rows_) {
        if (!matches(row, some)) continue;
        ++found;
        holds = holds && condition(row);
      }
      if (found == 0) throw std::logic_error("no such rows: " + std::string(some.sequence));
    }
    claims.push_back({text, holds});
  }

  std::vector<Claim> claims;

 private:
  static bool matches(const Row& row, const Which& which) {
    const auto is = [](std::string_view value, std::string_view asked) {
      return asked.empty() || value == asked;
    };
    return is(row.sequence, which.sequence) && is(row.form, which.form) &&
           is(row.strategy, which.strategy) && is(row.pivoting, which.pivoting);
  }

  const std::vector<Row>& rows_;
};

void judge_penalty_form(Judge& judge) {
  constexpr auto form = "penalty", near = "upright, alpha 1e10", nearer = "upright, alpha 1e14";
  judge.expect("positive definite T: kept diagonal pivots are exact",
               {{near, form, "refactor", "diagonal"},
                {nearer, form, "refactor", "diagonal"},
                {"masses swap", form, "refactor", "diagonal"},
                {"contacts", form, "refactor", "diagonal"}},
               below(kExact));
  judge.expect("positive definite T: with KLU's default rule the guard never fires",
               {{near, form, "guarded", "default"},
                {nearer, form, "guarded", "default"},
                {"masses swap", form, "guarded", "default"},
                {"contacts", form, "guarded", "default"}},
               never_repivoted);
  judge.expect("positive definite T, upright: kept pivots that were the largest lose digits",
               {{near, form, "refactor", "largest"}, {nearer, form, "refactor", "largest"}},
               above(kPoor));
}

void judge_saddle_point_form(Judge& judge) {
  constexpr auto form = "saddle-point";
  judge.expect("saddle-point form: kept diagonal pivots in the order of a simulation are exact",
               {{"upright, alpha 1e14", form, "refactor", "diagonal"},
                {"upright, alpha 1e16", form, "refactor", "diagonal"},
                {"upright, alpha 1e18", form, "refactor", "diagonal"},
                {"contacts", form, "refactor", "diagonal"},
                {"masses swap, rescaled", form, "refactor", "diagonal"}},
               below(kExact));
  judge.expect("saddle-point form: kept pivots that were the largest lose digits",
               {{"upright, alpha 1e14", form, "refactor", "largest"},
                {"upright, alpha 1e16", form, "refactor", "largest"},
                {"upright, alpha 1e18", form, "refactor", "largest"},
                {"contacts", form, "refactor", "largest"}},
               above(kPoor));
  judge.expect("saddle-point form: kept pivots in AMD's order lose digits",
               {{"upright, alpha 1e14, AMD", form, "refactor", "diagonal"},
                {"upright, alpha 1e14, AMD", form, "refactor", "default"}},
               above(kPoor));
  judge.expect("saddle-point form: in AMD's order they lose more with a greater alpha",
               {{"upright, alpha 1e18, AMD", form, "refactor", "diagonal"},
                {"upright, alpha 1e18, AMD", form, "refactor", "default"}},
               above(1e3 * kPoor));
  judge.expect("saddle-point form: kept scales and pivots lose digits when masses swap",
               {{"masses swap", form, "refactor", ""},
                {"masses swap, unscaled", form, "refactor", "default"}},
               above(kPoor));
  judge.expect("saddle-point form, indefinite T_0: kept diagonal pivots lose digits",
               {{"multipliers swap", form, "refactor", "diagonal"}}, above(kFair));
}

void judge_guard(Judge& judge) {
  constexpr auto penalty = "penalty", saddle = "saddle-point";
  judge.expect("guarded, factor: fair at least everywhere",
               {{"", "", "guarded", ""}, {"", "", "factor", ""}}, below(kFair));
  judge.expect("guarded: re-pivots where kept pivots lose digits",
               {{"upright, alpha 1e10", penalty, "guarded", "largest"},
                {"upright, alpha 1e14", "", "guarded", "largest"},
                {"upright, alpha 1e18", saddle, "guarded", "largest"},
                {"contacts", saddle, "guarded", "largest"},
                {"upright, alpha 1e14, AMD", saddle, "guarded", ""},
                {"upright, alpha 1e18, AMD", saddle, "guarded", ""},
                {"masses swap", saddle, "guarded", ""},
                {"masses swap, unscaled", saddle, "guarded", ""},
                {"multipliers swap", saddle, "guarded", "default"}},
               has_repivoted);
}

}  // namespace

std::vector<Claim> judge(const std::vector<Row>& rows) {
  Judge judge(rows);
  judge_penalty_form(judge);
  judge_saddle_point_form(judge);
  judge_guard(judge);
  return judge.claims;
}

}  // namespace mbs::stale_pivots
