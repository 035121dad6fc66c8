#include "viewer/capture/frames_file.hpp"

#include "engine/core/hash.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

std::string fraction_text(int64_t num, int64_t den) {
  return den == 1 ? fmt::format("{}", num) : fmt::format("{}/{}", num, den);
}

Json vector_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json frame_json(const FrameRecord& f) {
  Json out = {{"index", f.index}, {"file", frame_name(f.index)}, {"time", f.time}};
  if (f.at.exact()) {
    out["tick"] = f.at.tick;
  } else {
    out["between_ticks"] = {f.at.tick, f.at.tick + 1};
    out["part"] = fraction_text(f.at.rest_num, f.at.rest_den);
  }
  out["state_hash"] = hash_text(f.state_hash);
  out["draw_hash"] = hash_text(f.draw_hash);
  out["image_hash"] = hash_text(f.image_hash);
  return out;
}

Json times_json(const SequenceTimes& t) {
  const double per_frame = t.frames > 0 ? 1e3 / double(t.frames) : 0;
  return {{"frames", t.frames},
          {"first_frame_seconds", t.first_frame},
          {"total_seconds", t.total},
          {"ms_per_frame",
           {{"simulate", t.simulate * per_frame},
            {"extract", t.extract * per_frame},
            {"draw", t.draw * per_frame},
            {"read_back", t.read_back * per_frame},
            {"wait_for_encoder", t.wait * per_frame},
            {"encode_beside", t.encode * per_frame}}}};
}

Result<uint64_t> hash_from_text(const std::string& text) {
  uint64_t hash = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (error != std::errc{} || end != text.data() + text.size())
    return Error{ErrorCode::parse, "not a hash: " + text, {}, {}};
  return hash;
}

}  // namespace

std::string frame_name(uint64_t index) {
  return fmt::format("frame_{:06d}.png", index);
}

std::string ffmpeg_line(const std::filesystem::path& folder, Fraction fps) {
  return fmt::format(
      "ffmpeg -framerate {} -i '{}/frame_%06d.png' -c:v libx264 -crf 18 -pix_fmt yuv420p "
      "'{}/video.mp4'",
      fraction_text(fps.num, fps.den), folder.string(), folder.string());
}

Status write_frames_file(const std::filesystem::path& folder, const FramesFile& f) {
  Json out = {{"tumble_frames", 1},
              {"version", f.version},
              {"scene", f.scene},
              {"run", f.run},
              {"fps", fraction_text(f.fps.num, f.fps.den)},
              {"tick_hz", fraction_text(f.rate.num, f.rate.den)},
              {"size", {f.width, f.height}},
              {"camera",
               {{"name", f.camera_name},
                {"position", vector_json(f.camera.eye)},
                {"target", vector_json(f.camera.target)},
                {"fov_deg", f.camera.fov_deg}}},
              {"context", f.context},
              {"renderer", f.renderer},
              {"gl_version", f.gl_version},
              {"ffmpeg", ffmpeg_line(folder, f.fps)},
              {"frames_wanted", f.frames_wanted},
              {"complete", f.frames.size() >= f.frames_wanted},
              {"times", times_json(f.times)},
              {"frames", Json::array()}};
  // One frame per line: readable, and a third of the size of fully indented JSON.
  std::string text = out.dump(2, ' ', false, Json::error_handler_t::replace);
  const size_t end = text.rfind("[]");
  std::string lines = "[";
  for (const FrameRecord& frame : f.frames)
    lines += (lines.size() > 1 ? ",\n    " : "\n    ") + frame_json(frame).dump();
  text.replace(end, 2, lines + "\n  ]");
  return write_file(folder / "frames.json", text + "\n");
}

Result<FramesFile> read_frames_file(const std::filesystem::path& folder) {
  const auto path = folder / "frames.json";
  const auto text = read_file(path, size_t{1} << 30);
  if (!text) return text.error();
  const Json json = Json::parse(*text, nullptr, false);
  const Error bad{ErrorCode::parse, "not the frames.json of a sequence", path.string(),
                  "use --force to write the folder anew"};
  if (!json.is_object()) return bad;
  FramesFile out;
  try {
    out.run = json.at("run").get<std::string>();
    const auto fps = parse_fraction(json.at("fps").get<std::string>(), "fps");
    if (!fps) return bad;
    out.fps = *fps;
    for (const Json& frame : json.at("frames")) {
      FrameRecord record;
      record.index = frame.at("index").get<uint64_t>();
      record.time = frame.at("time").get<double>();
      const auto state = hash_from_text(frame.at("state_hash").get<std::string>());
      const auto draw = hash_from_text(frame.at("draw_hash").get<std::string>());
      const auto image = hash_from_text(frame.at("image_hash").get<std::string>());
      if (!state || !draw || !image || record.index != out.frames.size()) return bad;
      record.state_hash = *state;
      record.draw_hash = *draw;
      record.image_hash = *image;
      out.frames.push_back(record);
    }
  } catch (const Json::exception&) {
    return bad;
  }
  return out;
}

}  // namespace tumble
