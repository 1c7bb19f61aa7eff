// The kinds of things that a scene file may have. Each, or those that share their readers, has
// a file here with reader and lowering; kinds.cpp has the table of all.
#pragma once

#include <span>
#include <string_view>

#include "scene_file/lowering.hpp"
#include "scene_file/scene_reader.hpp"

namespace mbs {

/// A list of the file, such as "rods".
struct ListKind {
  std::string_view key;
  const char* schema;     ///< what an item is, in "$defs" of harness/scenes/scene.schema.json
  bool is_named = false;  ///< items of other lists name its items: it is read before them
  void (*read)(SceneReader& reader, const JsonNode& item) = nullptr;  ///< into the draft
  /// All items of the draft; null: Lowering::run() does it.
  void (*lower)(Lowering& lowering) = nullptr;
};

/// A constraint that is written with rows that the model has.
struct ConstraintKind {
  std::string_view type;  ///< as the file has it, and the schema's "constraint"
  /// What the constraint has beside its name and type.
  void (*read)(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) = nullptr;
  /// Writes its rows, and says what an output of their force is: of those it names, or else of all.
  Lowering::Force (*lower)(Lowering& lowering, const DraftConstraint& constraint) = nullptr;
};

/// In the order of lowering, which is that of the model's rows.
std::span<const ListKind> list_kinds();
std::span<const ConstraintKind> constraint_kinds();

}  // namespace mbs
