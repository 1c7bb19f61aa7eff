// Names and values of features.
#include "describe/features.hpp"

#include <algorithm>
#include <string_view>

namespace mbs {
namespace {

using nlohmann::json;

struct Feature {
  std::string_view name;
  const char* text;
};

constexpr Feature kFeatures[] = {{"one", "1"},
                                 {"n", "variables"},
                                 {"m", "constraints"},
                                 {"n2", "variables squared"},
                                 {"n3", "variables cubed"},
                                 {"jacobian", "non-zeros of the Jacobian"},
                                 {"mass", "non-zeros of M"},
                                 {"tangent", "non-zeros of the tangent"},
                                 {"fill", "fill of the tangent in %"},
                                 {"factor", "non-zeros of L"},
                                 {"per_column", "non-zeros a column of L"},
                                 {"flops", "operations of a factorization"},
                                 {"height", "height of the elimination tree"},
                                 {"widest", "widest column of L"},
                                 {"dimension", "dimension"},
                                 {"springs", "springs and laws"},
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
  const long springs = terms["springs"].get<long>() + terms["torsion_springs"].get<long>() +
                       terms["laws"].get<long>();
  return {{"one", 1},
          {"n", n},
          {"m", description["constraints"]},
          {"n2", n * n},
          {"n3", n * n * n},
          {"jacobian", description["jacobian"]["nonzeros"]},
          {"mass", description["mass"]["nonzeros"]},
          {"tangent", description["tangent"]["nonzeros"]},
          {"fill", 100.0 * description["tangent"]["fill"].get<double>()},
          {"factor", elimination["factor_nonzeros"]},
          {"per_column", elimination["per_column"]},
          {"flops", elimination["flops"]},
          {"height", elimination["height"]},
          {"widest", elimination["widest"]},
          {"dimension", description["dimension"]},
          {"springs", springs},
          {"saddle", description.at("scheme").at("take") == "saddle-point" ? 1 : 0}};
}

}  // namespace mbs
