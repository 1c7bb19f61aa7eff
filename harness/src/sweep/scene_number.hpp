// Finds a number in a scene's document by the path that a user types.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mbs {

/// Where in `document` the number at `path` is: the name of a parameter; or keys, and items by name or
/// index, separated by "/": "springs/s/stiffness", "points/B/velocity/0", "gravity/1". An item's name
/// is its "name", of a mass or force without one its "point", of a rod or spring without one the ends of "between"
/// joined by "-"; an index counts from 0 and is for items that no name fits. In names "~1" stands
/// for "/" and "~0" for "~". Throws UsageError that says what is there.
nlohmann::json::json_pointer find_number(const nlohmann::json& document, const std::string& path);

}  // namespace mbs
