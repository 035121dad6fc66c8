#include "engine/scene/build/fit_cache.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"

namespace tumble {
namespace {

constexpr uint32_t fit_format = 1;  ///< of the files, not of the method
constexpr std::string_view fit_section = "fitted primitive";

Bytes bytes_of_fit(const FittedPrimitive& fit) {
  ByteWriter out;
  out.begin_section(fit_section, fit_format);
  out.value(fit.shape.type);
  for (const double x : {fit.shape.radius, fit.shape.height, fit.shape.top_radius}) out.value(x);
  out.value(fit.shape.half_extents);
  out.value(fit.pose.x);
  out.value(fit.pose.q.coeffs());
  for (const double x : {fit.error.added, fit.error.missing, fit.volume, fit.mesh_volume})
    out.value(x);
  out.end_section();
  return out.take();
}

std::optional<FittedPrimitive> fit_of(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  if (in.begin_section(fit_section) != fit_format) return std::nullopt;
  FittedPrimitive fit;
  in.value(fit.shape.type);
  for (double* x : {&fit.shape.radius, &fit.shape.height, &fit.shape.top_radius}) in.value(*x);
  in.value(fit.shape.half_extents);
  in.value(fit.pose.x);
  in.value(fit.pose.q.coeffs());
  for (double* x : {&fit.error.added, &fit.error.missing, &fit.volume, &fit.mesh_volume})
    in.value(*x);
  if (!in.ok() || size_t(fit.shape.type) >= shape_type_count || made_of_mesh(fit.shape.type))
    return std::nullopt;
  return fit;
}

}  // namespace

Result<FittedPrimitive> FitCache::fit(const std::shared_ptr<const TriangleMesh>& mesh) const {
  ByteWriter key;
  key.value(fit_format);
  key.value(fit_version);
  add_to_key(key, *mesh);
  if (const auto kept = cache_.read(key.bytes()))
    if (auto known = fit_of(*kept)) return *std::move(known);
  auto made = fit_primitive(AabbTree(mesh));
  if (made) cache_.write(key.bytes(), bytes_of_fit(*made));
  return made;
}

}  // namespace tumble
