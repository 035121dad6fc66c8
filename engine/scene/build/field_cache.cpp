#include "engine/scene/build/field_cache.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"

namespace tumble {
namespace {

constexpr uint32_t field_format = 1;  ///< version of the file format, not of the method
constexpr std::string_view field_section = "distance field";

}  // namespace

Result<std::shared_ptr<const DistanceField>> FieldCache::field(
    const std::shared_ptr<const TriangleMesh>& mesh, double cell, Crew* crew) const {
  ByteWriter key;
  key.value(field_format);
  key.value(field_version);
  key.value(cell);
  add_to_key(key, *mesh);
  if (const auto kept = cache_.read(key.bytes())) {
    ByteReader in(*kept);
    if (in.begin_section(field_section) == field_format)
      if (auto known = DistanceField::read(in))
        return std::make_shared<const DistanceField>(*std::move(known));
  }
  DistanceFieldOptions options;
  options.cell = cell;
  options.crew = crew;
  auto made = make_distance_field(AabbTree(mesh), options);
  if (!made) return made.error();
  ByteWriter out;
  out.begin_section(field_section, field_format);
  made->write(out);
  out.end_section();
  cache_.write(key.bytes(), out.bytes());
  return std::make_shared<const DistanceField>(*std::move(made));
}

}  // namespace tumble
