#include "engine/scene/build/wrap_cache.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/scene/description/shape.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr uint32_t wrap_format = 2;  ///< version of the file format, not of the method
constexpr std::string_view wrap_section = "wrapped mesh";

/// The numbers of a report, in the order of the file.
template <class Report>
auto numbers_of(Report& r) {
  return std::array{&r.gap,     &r.offset, &r.cell,    &r.added,
                    &r.missing, &r.buried, &r.nearest, &r.bound};
}

Bytes bytes_of_wrap(const WrappedMesh& wrap) {
  ByteWriter out;
  out.begin_section(wrap_section, wrap_format);
  for (const double* x : numbers_of(wrap.report)) out.value(*x);
  out.vector(wrap.mesh.vertices);
  out.vector(wrap.mesh.triangles);
  out.end_section();
  return out.take();
}

std::optional<WrappedMesh> wrap_of_bytes(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  if (in.begin_section(wrap_section) != wrap_format) return std::nullopt;
  WrappedMesh out;
  for (double* x : numbers_of(out.report)) in.value(*x);
  in.vector(out.mesh.vertices);
  in.vector(out.mesh.triangles);
  if (!in.ok() || !validate(out.mesh)) return std::nullopt;
  return out;
}

}  // namespace

Result<WrappedMesh> WrapCache::wrap(const std::shared_ptr<const TriangleMesh>& mesh,
                                    const WrapOptions& options) const {
  if (Status s = validate(*mesh); !s) return s.error();
  const WrapOptions o = complete(options, bounds(*mesh));
  ByteWriter key;
  key.value(wrap_format);
  key.value(wrap_version);
  for (const double x : {o.gap, o.offset, o.cell, o.tolerance}) key.value(x);
  add_to_key(key, *mesh);
  if (const auto kept = cache_.read(key.bytes()))
    if (auto known = wrap_of_bytes(*kept)) return *std::move(known);
  auto made = wrap_mesh(AabbTree(mesh), o);
  if (made && validate(made->mesh)) cache_.write(key.bytes(), bytes_of_wrap(*made));
  return made;
}

WrapOptions wrap_options(const WrapDescription& d) {
  WrapOptions out;
  out.gap = d.gap.value_or(0);
  out.offset = d.offset.value_or(0);
  out.cell = d.cell.value_or(0);
  return out;
}

std::string wrap_note(const WrappedMesh& wrap) {
  const WrapReport& r = wrap.report;
  return fmt::format(
      "approximate: wrapped in {} triangles, which reach {:.3g} m outside the mesh and leave "
      "{:.3g} "
      "m of it out; of the mesh nothing is more than {:.3g} m beneath them, and what a ball of "
      "{:.3g} m does not pass is closed",
      wrap.mesh.triangles.size(), r.added, r.missing, r.buried, r.gap);
}

}  // namespace tumble
