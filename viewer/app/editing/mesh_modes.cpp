#include "viewer/app/editing/mesh_modes.hpp"

#include <chrono>
#include <utility>

namespace tumble {
namespace {

template <class T>
bool is_ready(const std::future<T>& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

void MeshModes::measure(const MeasureMesh& wanted) {
  if (measuring() || !wanted.mesh) return;
  measurement_ = std::async(std::launch::async, [this, mesh = wanted.mesh] {
    const Stoppable scope(&stop_);
    MeasuredMesh out{mesh, measure_representations(mesh)};
    return std::make_shared<const MeasuredMesh>(std::move(out));
  });
}

void MeshModes::change(const ChangeMeshMode& wanted) {
  if (changing() || !wanted.source) return;
  change_ = std::async(std::launch::async, [this, wanted] {
    const Stoppable scope(&stop_);
    // Options of the former representation do not apply to the new one.
    return Change{wanted, mesh_parts(wanted.source->mesh, {.mode = wanted.mode})};
  });
}

std::optional<MeshModes::Change> MeshModes::take() {
  if (is_ready(measurement_)) measured_ = measurement_.get();
  if (!is_ready(change_)) return std::nullopt;
  Change made = change_.get();
  if (std::exchange(forgotten_, false)) return std::nullopt;
  return made;
}

}  // namespace tumble
