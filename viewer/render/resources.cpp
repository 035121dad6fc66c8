#include "viewer/render/resources.hpp"

#include "engine/scene/resources.hpp"

namespace tumble {

Result<std::filesystem::path> resource_path(std::string_view relative) {
  return find_resource(relative);
}

}  // namespace tumble
