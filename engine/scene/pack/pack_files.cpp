#include "engine/scene/catalogue.hpp"
#include "engine/scene/json_tree.hpp"
#include "engine/scene/pack/pack.hpp"
#include "engine/scene/resources.hpp"
#include "engine/scene/saving/json_text_edit.hpp"
#include "engine/scene/writer.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

namespace tumble {
namespace fs = std::filesystem;
namespace {

Result<std::string> contents_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    return Error{ErrorCode::io, "cannot be read", file.string(), "see whether it may be read"};
  return std::move(text).str();
}

/// Files beside a glTF file that contain its binary data. Images are not packed, since they affect
/// neither collision nor drawing.
std::set<std::string> files_named_by(const fs::path& file, const std::string& bytes) {
  std::set<std::string> out;
  if (file.extension() != ".gltf" && file.extension() != ".GLTF") return out;
  const auto json = nlohmann::json::parse(bytes, nullptr, false);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return out;
  for (const auto& item : json["buffers"])
    if (item.is_object() && item.contains("uri") && item["uri"].is_string())
      if (const std::string uri = item["uri"]; !uri.starts_with("data:")) out.insert(uri);
  return out;
}

/// Whether a relative path leads out of its base folder.
bool leads_out(const fs::path& relative) {
  return relative.is_absolute() || relative.empty() ||
         std::ranges::find(relative, fs::path("..")) != relative.end();
}

/// The meshes of a scene, each file once, and where they are in the pack.
class MeshFiles {
 public:
  Status add(const std::string& name, const fs::path& file) {
    std::error_code none;
    const fs::path whole = fs::canonical(file, none);
    if (const auto known = places_.find(whole); known != places_.end()) {
      place_of[name] = known->second;
      return {};
    }
    auto bytes = contents_of(whole);
    if (!bytes) return bytes.error();
    const std::string folder = "meshes/" + name + "/";
    for (const std::string& other : files_named_by(whole, *bytes)) {
      if (leads_out(other))
        return Error{ErrorCode::io, "it names '" + other + "', which is not in its folder",
                     whole.string(), "put that file beside it, and name it without a path"};
      auto beside = contents_of(whole.parent_path() / other);
      if (!beside) return beside.error();
      files.push_back({folder + fs::path(other).lexically_normal().string(), *std::move(beside)});
    }
    const std::string place = folder + whole.filename().string();
    files.push_back({place, *std::move(bytes)});
    places_[whole] = place_of[name] = place;
    return {};
  }

  std::vector<PackFile> files;
  std::map<std::string, std::string> place_of;  ///< by name of the mesh

 private:
  std::map<fs::path, std::string> places_;
};

/// The text of the scene's file with new paths of its meshes.
std::string text_with_places(std::string text, const std::map<std::string, std::string>& places) {
  JsonTextEdit edit(std::move(text));
  for (const auto& [name, place] : places) {
    const JsonTextEdit::Path mesh = {PathStep{"meshes", {}}, PathStep{name, {}}};
    const auto value = edit.value(mesh);
    JsonTextEdit::Path file = mesh;
    if (value && value->starts_with('{')) file.push_back(PathStep{"file", {}});
    (void)edit.set(file, nlohmann::json(place).dump());
  }
  return edit.text();
}

/// Whether the text can be packed unchanged: it is a scene file that contains all its bodies
/// itself.
bool stands_alone(const fs::path& file, const std::string& text) {
  if (file.extension() != ".json" && file.extension() != ".jsonc") return false;
  FaultList ignored;
  const auto root = parse_json(text, file.string(), ignored);
  return root && !root->find("robots");
}

}  // namespace

Result<std::vector<PackFile>> pack_files(const std::string& scene,
                                         const std::optional<std::string>& given) {
  const auto file = resolve_scene(scene);
  if (!file) return file.error();
  SceneRead read = given ? read_scene(*given, file->string()) : read_scene_file(*file);
  if (!read.ok()) return to_error(read.faults);
  MeshFiles meshes;
  const fs::path folder = read.scene.source ? read.scene.source->folder : "";
  for (auto& [name, mesh] : read.scene.meshes.items) {
    const auto found = find_mesh_file(folder, mesh.file);
    if (!found) return found.error();
    if (Status s = meshes.add(name, *found); !s) return s.error();
    mesh.file = meshes.place_of[name];
  }
  auto text = given ? Result<std::string>(*given) : contents_of(*file);
  if (!text) return text.error();
  const bool kept = stands_alone(*file, *text);
  std::vector<PackFile> out;
  out.push_back(
      {file->stem().string() + ".json",
       kept ? text_with_places(*std::move(text), meshes.place_of) : write_scene(read.scene)});
  for (PackFile& f : meshes.files) out.push_back(std::move(f));
  return out;
}

}  // namespace tumble
