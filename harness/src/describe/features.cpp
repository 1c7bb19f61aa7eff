// Names and values of features.
#include "describe/features.hpp"

#include <algorithm>
#include <string_view>

#include "describe/elimination.hpp"

namespace mbs {
namespace {

using nlohmann::json;

struct Feature {
  std::string_view name;
  const char* text;
};

constexpr Feature kFeatures[] = {{"n", "variables"},
                                 {"m", "constraints"},
                                 {"jacobian", "non-zeros of the Jacobian"},
                                 {"mass", "non-zeros of M"},
                                 {"tangent", "non-zeros of the tangent"},
                                 {"fill", "fill of the tangent in %"},
                                 {"factor", "non-zeros of L"},
                                 {"per_column", "non-zeros a column of L"},
                                 {"flops", "operations of a factorization"},
                                 {"dense", "operations in % of those of a full L"},
                                 {"height", "height of the elimination tree"},
                                 {"widest", "widest column of L"},
                                 {"supernodes", "supernodes of L"},
                                 {"block", "columns a supernode"},
                                 {"saddle_factor", "non-zeros of the saddle-point matrix's L"},
                                 {"saddle_flops", "operations of its factorization"},
                                 {"passes", "passes a step"},
                                 {"saddle_passes", "passes a step in the saddle-point form"},
                                 {"dimension", "dimension"},
                                 {"springs", "springs and laws"},
                                 {"stiff", "springs or laws are there (1 or 0)"},
                                 {"saddle", "saddle-point form (1 or 0)"}};

const Feature* find(const std::string& name) {
  const auto found = std::ranges::find(kFeatures, name, &Feature::name);
  return found == std::end(kFeatures) ? nullptr : found;
}

}  // namespace

bool is_feature(const std::string& feature) { return find(feature) != nullptr; }

std::string feature_text(const std::string& feature) {
  const Feature* found = find(feature);
  return found == nullptr ? feature : found->text;
}

json features_json(const json& description) {
  const double n = description["variables"];
  const json& terms = description["terms"];
  const json& elimination = description["elimination"];
  const json& saddle = elimination["orderings"]["saddle-point"];
  const long springs = terms["springs"].get<long>() + terms["torsion_springs"].get<long>() +
                       terms["laws"].get<long>();
  json result = {{"n", n},
                 {"m", description["constraints"]},
                 {"jacobian", description["jacobian"]["nonzeros"]},
                 {"mass", description["mass"]["nonzeros"]},
                 {"tangent", description["tangent"]["nonzeros"]},
                 {"fill", 100.0 * description["tangent"]["fill"].get<double>()},
                 {"factor", elimination["factor_nonzeros"]},
                 {"per_column", elimination["per_column"]},
                 {"flops", elimination["flops"]},
                 {"dense", nullptr},
                 {"height", elimination["height"]},
                 {"widest", elimination["widest"]},
                 {"supernodes", elimination["supernodes"]},
                 {"block", nullptr},
                 {"saddle_factor", nullptr},
                 {"saddle_flops", nullptr},
                 {"passes", description["passes"]["penalty"]},
                 {"saddle_passes", description["passes"]["saddle-point"]},
                 {"dimension", description["dimension"]},
                 {"springs", springs},
                 {"stiff", springs > 0 ? 1 : 0},
                 {"saddle", description.at("scheme").at("take") == "saddle-point" ? 1 : 0}};
  if (!elimination["flops"].is_null() && n > 0) {
    result["dense"] = 100.0 * elimination["flops"].get<double>() / full_flops(n);
    result["block"] = n / elimination["supernodes"].get<double>();
  }
  if (!saddle.is_null()) {
    result["saddle_factor"] = saddle["factor_nonzeros"];
    result["saddle_flops"] = saddle["flops"];
  }
  return result;
}

}  // namespace mbs
