#include "viewer/app/mesh/mesh_field.hpp"

#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/watched.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/scene/build/field_cache.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/png.hpp"
#include "viewer/capture/progress.hpp"
#include "viewer/capture/stop_signal.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr size_t measured_points = 4000;
constexpr int slice_count = 24;    ///< pictures of a field
constexpr int longest_edge = 768;  ///< of a picture [px]

/// Colour for a distance.
std::array<uint8_t, 3> colour_of(const DistanceSample& s, double cell, double size, double pixel) {
  const double away = std::min(std::fabs(s.distance) / (0.3 * size), 1.0);
  std::array<double, 3> c =
      s.distance < 0 ? std::array{0.25 - 0.15 * away, 0.5 - 0.3 * away, 0.95 - 0.4 * away}
                     : std::array{0.98 - 0.3 * away, 0.75 - 0.4 * away, 0.4 - 0.25 * away};
  if (s.level == FieldLevel::band) {
    const double line = std::fabs(std::remainder(s.distance, 2 * cell));
    if (line < 0.6 * pixel)
      for (double& x : c) x *= 0.75;
  } else {
    for (double& x : c) x = 0.55 + 0.45 * x;
  }
  if (std::fabs(s.distance) < 0.8 * pixel) c = {0.05, 0.05, 0.05};
  std::array<uint8_t, 3> out;
  for (size_t k = 0; k < 3; ++k) out[k] = uint8_t(std::lround(255 * std::clamp(c[k], 0.0, 1.0)));
  return out;
}

/// The field at one height z, as a picture of its box.
Image slice_picture(const DistanceField& field, double z) {
  const Aabb box = field.layout().box();
  const double pixel = std::max(box.extent().x(), box.extent().y()) / longest_edge;
  Image out;
  out.width = std::max(1, int(std::lround(box.extent().x() / pixel)));
  out.height = std::max(1, int(std::lround(box.extent().y() / pixel)));
  out.channels = 3;
  out.pixels.resize(size_t(out.height) * out.row_bytes());
  size_t n = 0;
  for (int row = 0; row < out.height && !stop_requested(); ++row)
    for (int column = 0; column < out.width; ++column) {
      const Vec3 p(box.min.x() + (column + 0.5) * pixel, box.max.y() - (row + 0.5) * pixel, z);
      const auto c = colour_of(field.sample(p), field.cell(), box.extent().maxCoeff(), pixel);
      for (const uint8_t byte : c) out.pixels[n++] = byte;
    }
  return out;
}

std::filesystem::path slice_file(const std::filesystem::path& folder, int n) {
  return folder / fmt::format("slice_{:03}.png", n);
}

/// Makes the folder for slices; it must contain no slices unless overwriting is allowed.
Status make_slice_folder(const FieldRequest& request) {
  if (Status made = make_folder(request.slices); !made) return made;
  std::error_code error;
  for (int n = 0; n < slice_count && !request.force; ++n)
    if (const auto file = slice_file(request.slices, n); std::filesystem::exists(file, error))
      return Error{ErrorCode::io, "there are slices already", file.string(),
                   "--force overwrites them"};
  return {};
}

/// Removes a folder that it has made, if it is still empty at the end.
class NewFolder {
 public:
  explicit NewFolder(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code none;
    was_there_ = path_.empty() || std::filesystem::exists(path_, none);
  }
  ~NewFolder() {
    std::error_code none;
    if (!was_there_) std::filesystem::remove(path_, none);  // fails if it is not empty
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

 private:
  std::filesystem::path path_;
  bool was_there_ = true;
};

/// Draws all pictures before it writes any, so that a signal leaves either none of them or all;
/// returns how many.
Result<size_t> write_slices(const DistanceField& field, const Aabb& mesh,
                            const std::filesystem::path& folder, const StopSignal& stop) {
  WorkProgress progress("slices");
  std::vector<std::vector<std::byte>> pictures;
  for (int n = 0; n < slice_count; ++n) {
    const double z = mesh.min.z() + mesh.extent().z() * (n + 0.5) / slice_count;
    auto picture = encode_png(slice_picture(field, z));
    if (stop.requested()) return size_t{0};
    if (!picture) return picture.error();
    pictures.push_back(*std::move(picture));
    progress.show(double(n + 1) / slice_count);
  }
  for (int n = 0; n < slice_count; ++n)
    if (const Status written = write_file(slice_file(folder, n), pictures[size_t(n)]); !written)
      return written.error();
  return pictures.size();
}

}  // namespace

std::variant<FieldFacts, FieldFault> measure_field(const std::shared_ptr<const TriangleMesh>& mesh,
                                                   const FieldRequest& request,
                                                   const StopSignal& stop) {
  const Stoppable scope(&stop.flag());
  const NewFolder folder(request.slices);
  if (!request.slices.empty())
    if (const Status there = make_slice_folder(request); !there)
      return FieldFault{there.error(), true};
  WorkProgress progress("distance field");
  const ProgressSink show = [&](double share) { progress.show(share); };
  const Watched watched(&show);
  const AabbTree tree(mesh);
  Crew crew(int(std::clamp(std::thread::hardware_concurrency(), 1u, 64u)));
  DistanceFieldOptions options;
  options.cell = request.cell;
  options.error = request.error;
  const auto start = std::chrono::steady_clock::now();
  const auto made = FieldCache().field(mesh, field_cell(options, tree.bounds()), &crew);
  progress.finish();
  FieldFacts out;
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!made) return FieldFault{made.error(), false};
  const DistanceField* field = made->get();
  out.cell = field->cell();
  out.band = field->band();
  for (size_t k = 0; k < 3; ++k)
    out.cells[k] = FieldLayout::cells_along * field->layout().blocks[k];
  out.report = field->report();
  out.measured = measure_field_error(*field, tree, measured_points);
  if (!request.slices.empty()) {
    const auto written = write_slices(*field, tree.bounds(), request.slices, stop);
    if (!written) return FieldFault{written.error(), true};
    out.slices = *written;
    out.folder = request.slices;
  }
  if (stop.requested()) return FieldFault{stopped_error(), false};
  return out;
}

std::string field_text(const FieldFacts& f) {
  std::string out =
      fmt::format("  {:<16}{} x {} x {} cells of {:.4g} m in {:.3g} s\n", "distance field",
                  f.cells[0], f.cells[1], f.cells[2], f.cell, f.seconds);
  out +=
      fmt::format("  {:<16}{} blocks of {} bits, {} bytes, {:.4g} bytes/m2; band {:.4g} m\n", "",
                  f.report.blocks, f.report.bits, f.report.bytes, f.report.bytes_per_area, f.band);
  out +=
      fmt::format("  {:<16}in the band within {:.3g} m; measured rms {:.3g} m, largest {:.3g} m\n",
                  "", f.report.band_error, f.measured.rms, f.measured.largest);
  if (f.report.overlapped_nodes > 0)
    out += fmt::format(
        "  {:<16}parts overlap at {} nodes: distances inside are to the nearest triangle\n", "",
        f.report.overlapped_nodes);
  if (f.slices > 0)
    out += fmt::format("  {:<16}{} slices in {}\n", "", f.slices, f.folder.string());
  return out;
}

}  // namespace tumble
