#include "viewer/app/simulate/particle_export.hpp"

#include "engine/core/hash.hpp"
#include "engine/geometry/isosurface/marching_tetrahedra.hpp"
#include "engine/geometry/isosurface/smoothed_balls.hpp"
#include "engine/world/world.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/particles/ply.hpp"
#include "viewer/capture/particles/vtu.hpp"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Appended to a system's name in the name of its surface file; names in scenes have no '-'.
constexpr const char* surface_mark = "-surface";

/// The surface around particles; without particles, a mesh without triangles.
Result<TriangleMesh> surface_of(const ParticleSample& particles, double cell, Crew* crew) {
  double sum = 0;
  for (const double radius : particles.radius) sum += radius;
  if (!(sum > 0)) return TriangleMesh{};
  if (cell == 0) cell = 0.5 * sum / double(particles.size());
  const auto field = smoothed_balls(particles.x, particles.radius, cell, crew);
  if (!field) return field.error();
  return isosurface(*field);
}

/// Existing files of earlier exports of these systems, and their list, sorted by name.
std::vector<std::filesystem::path> export_files(const std::filesystem::path& folder,
                                                const std::vector<std::string>& stems) {
  std::vector<std::filesystem::path> out;
  const auto ours = [&](const std::string& name) {
    if (name == export_list_name) return true;
    return std::any_of(stems.begin(), stems.end(), [&](const std::string& stem) {
      return name == stem + ".pvd" || is_export_file_name(name, stem + surface_mark, "ply") ||
             is_export_file_name(name, stem, "ply") || is_export_file_name(name, stem, "vtu");
    });
  };
  std::error_code code;
  for (std::filesystem::directory_iterator it(folder, code), end; !code && it != end;
       it.increment(code))
    if (ours(it->path().filename().string())) out.push_back(it->path());
  std::sort(out.begin(), out.end());
  return out;
}

Error existing(const std::filesystem::path& file) {
  return {ErrorCode::io, "there are particles already", file.string(),
          "--resume goes on with them, --force overwrites them"};
}

bool among(const std::vector<ExportRecord>& frames, const std::string& name) {
  return std::any_of(frames.begin(), frames.end(),
                     [&](const ExportRecord& frame) { return frame.files.contains(name); });
}

}  // namespace

const std::vector<std::string>& particle_formats() {
  static const std::vector<std::string> names = {"ply", "vtu"};
  return names;
}

Result<ParticleExport> ParticleExport::begin(const World& world,
                                             const ParticleExportOptions& options) {
  ParticleExport out;
  out.options_ = options;
  if (!out.wanted()) return out;
  std::vector<std::string> names;
  const auto frame = world.frame();
  for (const auto& system : frame->particles) {
    out.systems_.push_back(system->id);
    names.push_back(system->name);
  }
  if (names.empty())
    return Error{ErrorCode::not_found, "the scene has no particle systems to export", {}, {}};
  ExportList& list = out.list_;
  list = {options.version, options.scene,     {},
          options.format,  options.fps,       world.settings().tick,
          options.frames,  file_stems(names), {}};
  std::string run = fmt::format("{}|{:016x}|{}|{}/{}|{}", options.run, world.state_hash(),
                                options.format, options.fps.num, options.fps.den, options.version);
  if (options.surface) run += fmt::format("|surface {}", *options.surface);
  list.run = hash_text(hash_bytes(run.data(), run.size()));
  if (options.surface)
    out.crew_ = std::make_unique<Crew>(
        options.threads > 0 ? options.threads
                            : int(std::max(1u, std::thread::hardware_concurrency())));
  if (Status made = out.make_room(); !made) return made.error();
  return out;
}

Status ParticleExport::make_room() {
  const auto& folder = options_.folder;
  if (Status made = make_folder(folder); !made) return made;
  auto lock = FolderLock::take(folder);
  if (!lock) return lock.error();
  lock_.emplace(*std::move(lock));
  const auto files = export_files(folder, list_.systems);
  if (!files.empty() && !options_.resume && !options_.force) return existing(files.front());
  if (!files.empty() && options_.resume && !options_.force) {
    auto earlier = read_export_list(folder);
    if (!earlier)
      return Error{ErrorCode::io, "cannot go on: " + earlier.error().message, earlier.error().place,
                   "choose another folder, or --force, which overwrites the files there"};
    if (earlier->run != list_.run)
      return Error{ErrorCode::io, "these are particles of another run (scene, settings or rate)",
                   files.front().string(), "choose another folder, or --force"};
    kept_ = std::min<uint64_t>(whole_frames(folder, *earlier), options_.frames);
    list_.frames = std::move(earlier->frames);
    list_.frames.resize(kept_);
  }
  remove_temporary_files(folder);
  // Removes files that will be written again, and those after the end of this run, which would
  // otherwise be taken for a part of it.
  std::error_code code;
  for (const auto& file : files)
    if (const std::string name = file.filename().string();
        name != export_list_name && !among(list_.frames, name))
      std::filesystem::remove(file, code);
  return save_list();  // first, so that an unwritable folder is detected before simulating
}

Status ParticleExport::add(const World& world) {
  if (!wanted() || !status_) return status_;
  const auto at = [&] { return frame_time(next_, list_.fps, list_.rate); };
  for (; next_ < frames_wanted() && at().last_tick() <= world.tick(); ++next_) {
    status_ = next_ < kept_ ? check_kept(world, next_) : write_frame(world, next_);
    if (!status_) return status_;
  }
  before_.clear();
  if (next_ >= kept_ && next_ < frames_wanted() && !at().exact() && at().tick == world.tick())
    for (const ParticleSystemId id : systems_) before_.push_back(*world.particles(id));
  return {};
}

Status ParticleExport::check_kept(const World& world, uint64_t k) const {
  if (k + 1 < kept_ || world.state_hash() == list_.frames[k].state_hash) return {};
  return Error{ErrorCode::internal,
               fmt::format("the state at frame {} is not the one of the interrupted run", k),
               (options_.folder / export_list_name).string(),
               "the scene, its assets or the program changed: use --force"};
}

Status ParticleExport::write_frame(const World& world, uint64_t k) {
  const FrameTime at = frame_time(k, list_.fps, list_.rate);
  ExportRecord record{k, world.state_hash(), {}};
  for (size_t i = 0; i < systems_.size(); ++i) {
    const ParticleSystem& now = *world.particles(systems_[i]);
    const ParticleSample sample =
        at.exact() ? sample_particles(now) : sample_particles(before_[i], now, at.s());
    if (Status written = write_system(i, sample, frame_seconds(k, list_.fps), record); !written)
      return written;
  }
  list_.frames.push_back(std::move(record));
  // Saved regularly, so that even a run that is killed can be resumed.
  if (std::chrono::steady_clock::now() - list_saved_ > std::chrono::seconds(2)) return save_list();
  return {};
}

Status ParticleExport::write(const std::string& name, const Result<std::string>& content,
                             ExportRecord& record) {
  if (!content) return content.error();
  record.files[name] = hash_bytes(content->data(), content->size());
  return write_file(options_.folder / name, *content);
}

Status ParticleExport::write_system(size_t i, const ParticleSample& sample, double time,
                                    ExportRecord& record) {
  const std::string name = export_file_name(list_.systems[i], record.index, list_.format);
  const bool vtu = list_.format == "vtu";
  Status written =
      vtu ? write(name, vtu_of(sample, time), record) : write(name, ply_of(sample, time), record);
  if (!written || !options_.surface) return written;
  return write_surface(i, sample, time, record);
}

Status ParticleExport::write_surface(size_t i, const ParticleSample& sample, double time,
                                     ExportRecord& record) {
  const auto mesh = surface_of(sample, *options_.surface, crew_.get());
  if (!mesh)
    return Error{mesh.error().code, mesh.error().message,
                 fmt::format("surface of {} at {} s", list_.systems[i], time),
                 "give larger cells: --surface=METRES"};
  return write(export_file_name(list_.systems[i] + surface_mark, record.index, "ply"),
               ply_of(*mesh, time), record);
}

Status ParticleExport::save_list() {
  list_saved_ = std::chrono::steady_clock::now();
  if (list_.format == "vtu") {
    for (const std::string& system : list_.systems) {
      std::vector<PvdEntry> entries;
      for (const ExportRecord& frame : list_.frames)
        entries.push_back({frame_seconds(frame.index, list_.fps),
                           export_file_name(system, frame.index, list_.format)});
      if (Status s = write_file(options_.folder / (system + ".pvd"), pvd_of(entries)); !s) return s;
    }
  }
  return write_export_list(options_.folder, list_);
}

Status ParticleExport::commit() {
  if (!wanted()) return {};
  const Status saved = save_list();
  return status_ ? saved : status_;
}

}  // namespace tumble
