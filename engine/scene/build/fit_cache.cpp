#include "engine/scene/build/fit_cache.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"

namespace tumble {
namespace {

constexpr uint32_t fit_format = 2;  ///< version of the file format, not of the method
constexpr std::string_view fit_section = "fitted primitives";

void write_fit(ByteWriter& out, const FittedPrimitive& fit) {
  out.value(fit.shape.type);
  for (const double x : {fit.shape.radius, fit.shape.height, fit.shape.top_radius}) out.value(x);
  out.value(fit.shape.half_extents);
  out.value(fit.pose.x);
  out.value(fit.pose.q.coeffs());
  for (const double x : {fit.error.added, fit.error.missing, fit.volume, fit.mesh_volume})
    out.value(x);
}

/// False if the data are invalid.
bool read_fit(ByteReader& in, FittedPrimitive& fit) {
  in.value(fit.shape.type);
  for (double* x : {&fit.shape.radius, &fit.shape.height, &fit.shape.top_radius}) in.value(*x);
  in.value(fit.shape.half_extents);
  in.value(fit.pose.x);
  in.value(fit.pose.q.coeffs());
  for (double* x : {&fit.error.added, &fit.error.missing, &fit.volume, &fit.mesh_volume})
    in.value(*x);
  return in.ok() && size_t(fit.shape.type) < shape_type_count && !made_of_mesh(fit.shape.type);
}

Bytes bytes_of_fits(const std::vector<FittedPrimitive>& fits) {
  ByteWriter out;
  out.begin_section(fit_section, fit_format);
  out.value(uint64_t{fits.size()});
  for (const FittedPrimitive& fit : fits) write_fit(out, fit);
  out.end_section();
  return out.take();
}

std::optional<std::vector<FittedPrimitive>> fits_of_bytes(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  if (in.begin_section(fit_section) != fit_format) return std::nullopt;
  std::vector<FittedPrimitive> out;
  const auto count = in.get<uint64_t>();
  for (uint64_t n = 0; n < count && in.ok(); ++n)
    if (!read_fit(in, out.emplace_back())) return std::nullopt;
  if (!in.ok() || out.empty()) return std::nullopt;
  return out;
}

}  // namespace

Result<std::vector<FittedPrimitive>> FitCache::fits(
    const std::shared_ptr<const TriangleMesh>& mesh) const {
  ByteWriter key;
  key.value(fit_format);
  key.value(fit_version);
  add_to_key(key, *mesh);
  if (const auto kept = cache_.read(key.bytes()))
    if (auto known = fits_of_bytes(*kept)) return *std::move(known);
  auto made = fit_primitives(AabbTree(mesh));
  if (made) cache_.write(key.bytes(), bytes_of_fits(*made));
  return made;
}

Result<FittedPrimitive> FitCache::fit(const std::shared_ptr<const TriangleMesh>& mesh) const {
  auto all = fits(mesh);
  if (!all) return all.error();
  return std::move(all->front());
}

}  // namespace tumble
