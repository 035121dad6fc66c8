#pragma once
#include "viewer/app/editing/arranger.hpp"
#include "viewer/app/editing/builder.hpp"
#include "viewer/app/editing/clipboard.hpp"
#include "viewer/app/editing/duplicator.hpp"
#include "viewer/app/editing/mesh_modes.hpp"
#include "viewer/app/editing/mesh_palette.hpp"
#include "viewer/app/editing/parts_desk.hpp"
#include "viewer/app/session/refusal.hpp"
#include "viewer/app/session/selected_def.hpp"
#include "viewer/app/window/pointer.hpp"

#include <memory>
#include <optional>
#include <utility>

namespace tumble {

/// What bodies and parts are made, moved, copied and changed with.
struct EditingTools {
  Builder builder;
  Duplicator duplicator;
  Arranger arranger;
  BodyClipboard clipboard;
  MeshPalette mesh_palette;
  MeshModes mesh_modes;
  SelectedDef selected_def;
  PartsDesk parts;
  std::optional<PointerBox> box;  ///< being drawn around bodies
  Refusal refusal;                ///< by the world, of what was asked of it

  /// Another world is shown, with these parts; what was copied is kept.
  void open(std::shared_ptr<const SceneDescription> described, std::shared_ptr<LiveParts> live) {
    builder.cancel();
    duplicator.forget();
    arranger.end();
    mesh_modes.forget();
    selected_def.forget();
    parts.open(std::move(described), std::move(live));
    box.reset();
  }
};

}  // namespace tumble
