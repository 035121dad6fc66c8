#include "viewer/capture/particles/export_list.hpp"

#include "engine/core/hash.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <algorithm>
#include <charconv>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using ListJson = nlohmann::ordered_json;

std::string rate_text(int64_t num, int64_t den) {
  return den == 1 ? fmt::format("{}", num) : fmt::format("{}/{}", num, den);
}

ListJson record_json(const ExportRecord& record, const ExportList& list) {
  const FrameTime at = frame_time(record.index, list.fps, list.rate);
  ListJson out = {{"index", record.index}, {"time", frame_seconds(record.index, list.fps)}};
  if (at.exact()) {
    out["tick"] = at.tick;
  } else {
    out["between_ticks"] = {at.tick, at.tick + 1};
    out["part"] = rate_text(at.rest_num, at.rest_den);
  }
  out["state_hash"] = hash_text(record.state_hash);
  for (const auto& [name, hash] : record.files) out["files"][name] = hash_text(hash);
  return out;
}

/// Throws nlohmann::json::exception if the value is not a valid record.
ExportRecord record_of(const ListJson& json) {
  const auto hash = [](const ListJson& text) {
    const auto digits = text.get<std::string>();
    uint64_t value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    return value;
  };
  ExportRecord out;
  out.index = json.at("index").get<uint64_t>();
  out.state_hash = hash(json.at("state_hash"));
  for (const auto& [name, value] : json.at("files").items()) out.files[name] = hash(value);
  return out;
}

bool is_whole(const std::filesystem::path& folder, const ExportRecord& record) {
  return std::all_of(record.files.begin(), record.files.end(), [&](const auto& file) {
    const auto content = read_file(folder / file.first, size_t{1} << 34);
    return content.ok() && hash_bytes(content->data(), content->size()) == file.second;
  });
}

}  // namespace

std::string export_file_name(const std::string& stem, uint64_t index, const std::string& ending) {
  return fmt::format("{}_{:06d}.{}", stem, index, ending);
}

bool is_export_file_name(const std::string& name, const std::string& stem,
                         const std::string& ending) {
  const size_t front = stem.size() + 1, back = ending.size() + 1;
  return name.size() >= front + 6 + back && name.starts_with(stem + "_") &&
         name.ends_with("." + ending) &&
         std::all_of(name.begin() + std::ptrdiff_t(front), name.end() - std::ptrdiff_t(back),
                     [](char c) { return c >= '0' && c <= '9'; });
}

std::vector<std::string> file_stems(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    std::string stem = name.empty() ? "particles" : name;
    for (char& c : stem) {
      const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
      if (!letter && !(c >= '0' && c <= '9') && c != '-' && c != '_' && c != '.') c = '_';
    }
    if (stem[0] == '.' || stem[0] == '-') stem[0] = '_';
    std::string unique = stem;
    for (int n = 2; !taken.insert(unique).second; ++n) unique = fmt::format("{}-{}", stem, n);
    out.push_back(unique);
  }
  return out;
}

Status write_export_list(const std::filesystem::path& folder, const ExportList& list) {
  ListJson out = {{"tumble_particles", 1},
                  {"version", list.version},
                  {"scene", list.scene},
                  {"run", list.run},
                  {"format", list.format},
                  {"fps", rate_text(list.fps.num, list.fps.den)},
                  {"tick_hz", rate_text(list.rate.num, list.rate.den)},
                  {"systems", list.systems},
                  {"frames_wanted", list.frames_wanted},
                  {"complete", list.frames.size() >= list.frames_wanted},
                  {"frames", ListJson::array()}};
  // One frame per line: readable, and a third of the size of fully indented JSON.
  std::string text = out.dump(2, ' ', false, ListJson::error_handler_t::replace);
  std::string lines = "[";
  for (const ExportRecord& record : list.frames)
    lines += (lines.size() > 1 ? ",\n    " : "\n    ") + record_json(record, list).dump();
  text.replace(text.rfind("[]"), 2, lines + "\n  ]");
  return write_file(folder / export_list_name, text + "\n");
}

Result<ExportList> read_export_list(const std::filesystem::path& folder) {
  const auto path = folder / export_list_name;
  const auto text = read_file(path);
  if (!text) return text.error();
  const Error bad{ErrorCode::parse, "not the list of an export of particles", path.string(),
                  "use --force to write the folder anew"};
  const ListJson json = ListJson::parse(*text, nullptr, false);
  if (!json.is_object()) return bad;
  ExportList out;
  try {
    out.run = json.at("run").get<std::string>();
    for (const ListJson& record : json.at("frames")) {
      out.frames.push_back(record_of(record));
      if (out.frames.back().index + 1 != out.frames.size()) return bad;
    }
  } catch (const ListJson::exception&) {
    return bad;
  }
  return out;
}

size_t whole_frames(const std::filesystem::path& folder, const ExportList& list) {
  const auto broken =
      std::find_if(list.frames.begin(), list.frames.end(),
                   [&](const ExportRecord& record) { return !is_whole(folder, record); });
  return size_t(broken - list.frames.begin());
}

}  // namespace tumble
