#include "viewer/app/mesh/pieces_file.hpp"

#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/particles/vtu.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

Status write_obj(const std::filesystem::path& file, const ConvexDecomposition& pieces) {
  FileWriter out(file);
  std::string text = fmt::format("# {} convex pieces by Tumble, metres\n", pieces.pieces.size());
  size_t first = 1;
  for (size_t n = 0; n < pieces.pieces.size(); ++n) {
    const ConvexPolyhedron& p = pieces.pieces[n].hull;
    text += fmt::format("o piece_{:03}\n", n);
    for (const Vec3& v : p.vertices) text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
    for (size_t f = 0; f < p.face_count(); ++f) {
      text += "f";
      for (const uint32_t v : p.face(f)) text += fmt::format(" {}", first + v);
      text += "\n";
    }
    first += p.vertices.size();
    out.append(text);
    text.clear();
  }
  out.append(text);
  return out.commit();
}

Status write_mesh_obj(const std::filesystem::path& file, const TriangleMesh& mesh) {
  constexpr size_t flushed = size_t{1} << 20;  // characters per write
  FileWriter out(file);
  std::string text = "# a wrapped mesh by Tumble, metres\n";
  const auto flush = [&](size_t least) {
    if (text.size() < least) return;
    out.append(text);
    text.clear();
  };
  for (const Vec3& v : mesh.vertices) {
    text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
    flush(flushed);
  }
  for (const Triangle& t : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    flush(flushed);
  }
  flush(0);
  return out.commit();
}

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

/// The binary data and the JSON of a glTF 2.0 asset (Khronos, "glTF 2.0 Specification", 2021).
class GltfAsset {
 public:
  void add(const std::string& name, const TriangleMesh& mesh) {
    const size_t positions = add_positions(mesh), indices = add_indices(mesh);
    const size_t n = json_["meshes"].size();
    json_["meshes"].push_back(
        {{"name", name},
         {"primitives",
          Json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}})}});
    json_["nodes"].push_back({{"name", name}, {"mesh", n}});
    json_["scenes"][0]["nodes"].push_back(n);
  }

  /// As .gltf, with the binary data embedded in the text.
  std::string text() const {
    return json_text("data:application/octet-stream;base64," + base64(numbers_));
  }
  /// As .glb: a header of 12 bytes, then JSON and binary data as chunks whose lengths are multiples
  /// of four.
  std::string binary() const {
    std::string json = json_text({});
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string out = "glTF";
    append_number(out, 2);
    append_number(out, uint32_t(12 + 8 + json.size() + 8 + numbers_.size()));
    append_number(out, uint32_t(json.size()));
    out += "JSON" + json;
    append_number(out, uint32_t(numbers_.size()));
    out.append("BIN\0", 4);
    return out + numbers_;
  }

 private:
  static constexpr int floats = 5126, unsigned_ints = 5125;          // component types
  static constexpr int array_buffer = 34962, element_array = 34963;  // targets of buffer views

  static void append_number(std::string& out, uint32_t value) { append(out, &value, 1); }
  template <class Number>
  static void append(std::string& out, const Number* values, size_t count) {
    out.append(reinterpret_cast<const char*>(values), count * sizeof(Number));
  }
  std::string json_text(const std::string& uri) const {
    Json out = json_;
    out["buffers"][0]["byteLength"] = numbers_.size();
    if (!uri.empty()) out["buffers"][0]["uri"] = uri;
    return out.dump();
  }
  size_t add_view(size_t begin, int target) {
    json_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", begin},
                                    {"byteLength", numbers_.size() - begin},
                                    {"target", target}});
    return json_["bufferViews"].size() - 1;
  }
  size_t add_accessor(Json accessor) {
    json_["accessors"].push_back(std::move(accessor));
    return json_["accessors"].size() - 1;
  }
  size_t add_positions(const TriangleMesh& mesh) {
    const size_t begin = numbers_.size();
    Vec3f low = mesh.vertices[0].cast<float>(), high = low;
    for (const Vec3& v : mesh.vertices) {
      const Vec3f p = v.cast<float>();
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
      append(numbers_, p.data(), 3);
    }
    return add_accessor({{"bufferView", add_view(begin, array_buffer)},
                         {"componentType", floats},
                         {"count", mesh.vertices.size()},
                         {"type", "VEC3"},
                         {"min", {low.x(), low.y(), low.z()}},
                         {"max", {high.x(), high.y(), high.z()}}});
  }
  size_t add_indices(const TriangleMesh& mesh) {
    const size_t begin = numbers_.size();
    for (const Triangle& t : mesh.triangles) append(numbers_, t.data(), 3);
    return add_accessor({{"bufferView", add_view(begin, element_array)},
                         {"componentType", unsigned_ints},
                         {"count", 3 * mesh.triangles.size()},
                         {"type", "SCALAR"}});
  }

  std::string numbers_;
  Json json_ = {{"asset", {{"version", "2.0"}, {"generator", "Tumble"}}},
                {"scene", 0},
                {"scenes", Json::array({{{"nodes", Json::array()}}})},
                {"nodes", Json::array()},
                {"meshes", Json::array()},
                {"accessors", Json::array()},
                {"bufferViews", Json::array()},
                {"buffers", Json::array({Json::object()})}};
};

std::string lower_ending(const std::filesystem::path& file) {
  std::string out = file.extension().string();
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return out;
}

bool is_gltf(const std::filesystem::path& file) {
  const std::string ending = lower_ending(file);
  return ending == ".glb" || ending == ".gltf";
}

Status write_asset(const std::filesystem::path& file, const GltfAsset& asset) {
  return write_file(file, lower_ending(file) == ".glb" ? asset.binary() : asset.text());
}

}  // namespace

std::vector<std::string> piece_file_endings() {
  return {".obj", ".glb", ".gltf"};
}

Status write_pieces(const std::filesystem::path& file, const ConvexDecomposition& pieces) {
  if (!is_gltf(file)) return write_obj(file, pieces);
  GltfAsset asset;
  for (size_t n = 0; n < pieces.pieces.size(); ++n)
    asset.add(fmt::format("piece_{:03}", n), to_mesh(pieces.pieces[n].hull));
  return write_asset(file, asset);
}

Status write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh) {
  if (!is_gltf(file)) return write_mesh_obj(file, mesh);
  GltfAsset asset;
  asset.add("wrap", mesh);
  return write_asset(file, asset);
}

}  // namespace tumble
