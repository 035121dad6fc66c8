#include "tests/fuzz/mesh_files.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The bytes of a number as this machine has them, little end first.
template <class T>
void put(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}
template <class T>
void put_big(std::string& out, T value) {
  put(out, value);
  std::reverse(out.end() - std::ptrdiff_t(sizeof value), out.end());
}

std::string lines_of_faces(const TriangleMesh& mesh, const char* start, uint32_t first) {
  std::string out;
  for (const Triangle& t : mesh.triangles)
    out += fmt::format("{}{} {} {}\n", start, t[0] + first, t[1] + first, t[2] + first);
  return out;
}
std::string lines_of_points(const TriangleMesh& mesh, const char* start) {
  std::string out;
  for (const Vec3& v : mesh.vertices)
    out += fmt::format("{}{} {} {}\n", start, v.x(), v.y(), v.z());
  return out;
}

std::string off_file(const TriangleMesh& mesh) {
  return fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size()) +
         lines_of_points(mesh, "") + lines_of_faces(mesh, "3 ", 0);
}

std::string ply_header(const TriangleMesh& mesh, const char* encoding) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment made by hand\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      encoding, mesh.vertices.size(), mesh.triangles.size());
}
std::string little_ply(const TriangleMesh& mesh) {
  std::string out = ply_header(mesh, "binary_little_endian");
  for (const Vec3& v : mesh.vertices)
    for (const double x : {v.x(), v.y(), v.z()}) put(out, x);
  for (const Triangle& t : mesh.triangles) {
    put(out, uint8_t(3));
    for (const uint32_t i : t) put(out, i);
  }
  return out;
}
std::string big_ply(const TriangleMesh& mesh) {
  std::string out = ply_header(mesh, "binary_big_endian");
  for (const Vec3& v : mesh.vertices)
    for (const double x : {v.x(), v.y(), v.z()}) put_big(out, x);
  for (const Triangle& t : mesh.triangles) {
    put(out, uint8_t(3));
    for (const uint32_t i : t) put_big(out, i);
  }
  return out;
}

Vec3 normal_of(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
}
std::string text_stl(const TriangleMesh& mesh) {
  std::string out = "solid part\n";
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = normal_of(mesh, t);
    out += fmt::format("facet normal {} {} {}\n outer loop\n", n.x(), n.y(), n.z());
    for (const uint32_t i : t) {
      const Vec3& v = mesh.vertices[i];
      out += fmt::format("  vertex {} {} {}\n", v.x(), v.y(), v.z());
    }
    out += " endloop\nendfacet\n";
  }
  return out + "endsolid part\n";
}
void put_point(std::string& out, const Vec3& v) {
  for (const double x : {v.x(), v.y(), v.z()}) put(out, float(x));
}
std::string binary_stl(const TriangleMesh& mesh) {
  std::string out(80, ' ');
  put(out, uint32_t(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    put_point(out, normal_of(mesh, t));
    for (const uint32_t i : t) put_point(out, mesh.vertices[i]);
    put(out, uint16_t(0));
  }
  return out;
}

std::string base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : digits[(group >> (18 - 6 * k)) & 63];
  }
  return out;
}
/// Corners, then points: offsets are multiples of four.
std::string gltf_buffer(const TriangleMesh& mesh) {
  std::string out;
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t i : t) put(out, i);
  for (const Vec3& v : mesh.vertices) put_point(out, v);
  return out;
}
/// `uri` is a member of the buffer, or empty in a GLB file.
std::string gltf_json(const TriangleMesh& mesh, const std::string& uri) {
  const size_t corners = mesh.triangles.size() * 3, points = mesh.vertices.size();
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"mesh":0,"translation":[1,0,0],"scale":[1,2,1]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":1}},"indices":0}}]}}],
"accessors":[{{"bufferView":0,"componentType":5125,"count":{},"type":"SCALAR"}},
{{"bufferView":1,"componentType":5126,"count":{},"type":"VEC3","min":[{},{},{}],"max":[{},{},{}]}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],
"buffers":[{{"byteLength":{}{}}}]}})",
      corners, points, low.x(), low.y(), low.z(), high.x(), high.y(), high.z(), 4 * corners,
      4 * corners, 12 * points, 4 * corners + 12 * points, uri);
}
std::string gltf_file(const TriangleMesh& mesh) {
  return gltf_json(
      mesh, ",\"uri\":\"data:application/octet-stream;base64," + base64(gltf_buffer(mesh)) + "\"");
}
std::string glb_file(const TriangleMesh& mesh) {
  std::string json = gltf_json(mesh, "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = gltf_buffer(mesh);
  std::string out = "glTF";
  put(out, uint32_t(2));
  put(out, uint32_t(12 + 8 + json.size() + 8 + buffer.size()));
  put(out, uint32_t(json.size()));
  out += "JSON" + json;
  put(out, uint32_t(buffer.size()));
  out += std::string("BIN\0", 4) + buffer;
  return out;
}

}  // namespace

std::vector<NamedFile> mesh_in_every_format(const TriangleMesh& mesh) {
  return {
      {"a.obj", lines_of_points(mesh, "v ") + lines_of_faces(mesh, "f ", 1)},
      {"b.off", off_file(mesh)},
      {"c.ply",
       ply_header(mesh, "ascii") + lines_of_points(mesh, "") + lines_of_faces(mesh, "3 ", 0)},
      {"d.stl", text_stl(mesh)},
      {"e.gltf", gltf_file(mesh)},
      {"f.ply", little_ply(mesh), false},
      {"g.ply", big_ply(mesh), false},
      {"h.stl", binary_stl(mesh), false},
      {"i.glb", glb_file(mesh), false},
  };
}

}  // namespace tumble
