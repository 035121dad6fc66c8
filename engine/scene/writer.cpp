#include "engine/scene/writer.hpp"

#include "engine/scene/description.hpp"
#include "engine/scene/visitors/json_text.hpp"
#include "engine/scene/visitors/object_writer.hpp"

namespace tumble {

std::string write_scene(const SceneDescription& scene) {
  Json out = {{"$schema", "tumble.schema.json"}};
  const Json members = write_object(scene);
  for (const auto& item : members.items()) out[item.key()] = item.value();
  return pretty(out);
}

}  // namespace tumble
