#pragma once
#include "viewer/app/editing/arranger.hpp"
#include "viewer/app/editing/builder.hpp"
#include "viewer/app/editing/clipboard.hpp"
#include "viewer/app/editing/duplicator.hpp"
#include "viewer/app/editing/mesh_modes.hpp"
#include "viewer/app/editing/mesh_palette.hpp"
#include "viewer/app/editing/parts_controller.hpp"
#include "viewer/app/session/pinned_defs.hpp"
#include "viewer/app/session/refusal.hpp"
#include "viewer/app/session/selected_def.hpp"
#include "viewer/app/window/pointer.hpp"

#include <memory>
#include <optional>
#include <utility>

namespace tumble {

/// The tools that create, move, copy and change bodies and parts.
struct EditingTools {
  Builder builder;
  Duplicator duplicator;
  Arranger arranger;
  BodyClipboard clipboard;
  MeshPalette mesh_palette;
  MeshModes mesh_modes;
  SelectedDef selected_def;
  PinnedDefs pinned_defs;
  PartsController parts;
  std::optional<PointerBox> box;  ///< selection box being dragged
  Refusal refusal;                ///< why the world rejected a request

  /// To be called when another world is shown, with its parts; the clipboard is kept.
  void open(std::shared_ptr<const SceneDescription> described, std::shared_ptr<LiveParts> live) {
    builder.cancel();
    duplicator.forget();
    arranger.end();
    mesh_modes.forget();
    selected_def.forget();
    pinned_defs.forget();
    parts.open(std::move(described), std::move(live));
    box.reset();
  }
};

}  // namespace tumble
