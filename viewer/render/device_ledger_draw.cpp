#include "engine/core/hash.hpp"
#include "viewer/render/device_ledger.hpp"

#include <fmt/format.h>

namespace tumble {

bool DeviceLedger::draw(const DrawCall& call) {
  if (!current_) {
    fault("draw outside a pass");
    return false;
  }
  const Pipeline* pipeline = pipelines_.find(call.pipeline);
  if (!pipeline) {
    fault("draw with a pipeline that does not exist");
    return false;
  }
  if (call.count == 0 || call.instance_count == 0) {
    fault("draw of nothing with " + pipeline->desc.name);
    return false;
  }
  const bool good = check_target(call, *pipeline) && check_inputs(call, *pipeline) &&
                    check_indices(call, *pipeline) && check_bindings(call, *pipeline);
  if (good) hash_draw(call, *pipeline);
  return good;
}

bool DeviceLedger::check_target(const DrawCall& call, const Pipeline& pipeline) {
  const Target& target = *targets_.find(current_);
  const PipelineDesc& d = pipeline.desc;
  const bool needs_depth = d.depth_test != DepthTest::none || d.depth_write;
  const char* wrong = nullptr;
  if (needs_depth && target.desc.depth == DepthAttachment::none)
    wrong = "depth, the target has none";
  if (d.colour_write && target.desc.colour == ColourAttachment::none)
    wrong = "colour, the target has none";
  if (wrong) fault(d.name + " writes " + wrong);
  if (!wrong && call.scissor) {
    const ScissorRect& s = *call.scissor;
    if (s.x < 0 || s.y < 0 || s.width < 1 || s.height < 1 || s.x + s.width > target.desc.width ||
        s.y + s.height > target.desc.height)
      fault(wrong = "scissor outside the target");
  }
  return !wrong;
}

bool DeviceLedger::check_inputs(const DrawCall& call, const Pipeline& pipeline) {
  const PipelineDesc& d = pipeline.desc;
  for (int slot = 0; slot < 2; ++slot) {
    const uint64_t stride = d.stride[size_t(slot)];
    if (stride == 0) continue;
    const Buffer* b = buffers_.find(slot == 0 ? call.vertices : call.instances);
    if (!b || !b->defined || b->use != BufferUse::vertex) {
      fault(fmt::format("{}: slot {} has no vertex buffer with contents", d.name, slot));
      return false;
    }
    uint64_t need = stride * call.instance_count + call.instance_offset;
    if (slot == 0) need = call.indices ? 0 : stride * (uint64_t(call.first) + call.count);
    if (need > b->size) {
      fault(fmt::format("{}: slot {} needs {} bytes, the buffer has {}", d.name, slot, need,
                        b->size));
      return false;
    }
  }
  return true;
}

bool DeviceLedger::check_indices(const DrawCall& call, const Pipeline& pipeline) {
  if (!call.indices) return true;
  const PipelineDesc& d = pipeline.desc;
  const Buffer* b = buffers_.find(call.indices);
  const uint64_t end = uint64_t(call.first) + call.count;
  if (!b || !b->defined || b->use != BufferUse::index || end * 4 > b->size) {
    fault(fmt::format("{}: indices up to {} are not in an index buffer", d.name, end));
    return false;
  }
  if (!strict_ || d.stride[0] == 0) return true;
  const int64_t vertices = int64_t(buffers_.find(call.vertices)->size / d.stride[0]);
  for (uint64_t i = call.first; i < end; ++i) {
    const int64_t v = int64_t(b->indices[i]) + call.base_vertex;
    if (v >= 0 && v < vertices) continue;
    fault(fmt::format("{}: index {} is vertex {} of {}", d.name, i, v, vertices));
    return false;
  }
  return true;
}

bool DeviceLedger::check_bindings(const DrawCall& call, const Pipeline& pipeline) {
  const PipelineDesc& d = pipeline.desc;
  for (size_t i = 0; i < d.textures.size(); ++i) {
    const Texture* t = textures_.find(call.textures[i]);
    if (!t) {
      fault(d.name + ": no texture for " + d.textures[i]);
      return false;
    }
    if (t->owner && t->owner == current_) {
      fault(d.name + ": " + d.textures[i] + " is being drawn into");
      return false;
    }
  }
  for (size_t i = 0; i < d.uniform_blocks.size(); ++i) {
    const UniformRange& u = call.uniforms[i];
    const Buffer* b = buffers_.find(u.buffer);
    const bool good = b && b->defined && b->use == BufferUse::uniform && u.size > 0 &&
                      u.offset % 256 == 0 && uint64_t(u.offset) + u.size <= b->size;
    if (good) continue;
    fault(fmt::format("{}: bytes {} to {} are not in a uniform buffer for {}", d.name, u.offset,
                      u.offset + u.size, d.uniform_blocks[i]));
    return false;
  }
  return true;
}

uint64_t DeviceLedger::hash_of(const DrawCall& call, const Pipeline& pipeline, uint64_t seed) {
  const PipelineDesc& d = pipeline.desc;
  const auto mix = [&seed](const auto& value) { seed = hash_bytes(&value, sizeof value, seed); };
  mix(pipeline.content);
  const uint32_t numbers[] = {call.first, call.count, uint32_t(call.base_vertex),
                              call.instance_count, call.instance_offset};
  mix(numbers);
  if (d.stride[0]) mix(buffers_.find(call.vertices)->content);
  if (d.stride[1]) mix(buffers_.find(call.instances)->content);
  if (call.indices) mix(buffers_.find(call.indices)->content);
  for (size_t i = 0; i < d.textures.size(); ++i) mix(textures_.find(call.textures[i])->content);
  for (size_t i = 0; i < d.uniform_blocks.size(); ++i) {
    const UniformRange& u = call.uniforms[i];
    mix(buffers_.find(u.buffer)->content);
    const uint32_t range[] = {u.offset, u.size};
    mix(range);
  }
  if (call.scissor) mix(*call.scissor);
  return seed;
}

void DeviceLedger::hash_draw(const DrawCall& call, const Pipeline& pipeline) {
  const PipelineDesc& d = pipeline.desc;
  stats_.hash = hash_of(call, pipeline, stats_.hash);
  const bool replaces = d.covers_target && d.blend == Blend::none &&
                        d.depth_test == DepthTest::none && d.colour_write && !call.scissor;
  if (replaces && depth_is_fresh_) pass_content_ = 1;
  if (d.depth_write) depth_is_fresh_ = false;
  pass_content_ = hash_of(call, pipeline, pass_content_);
  for (size_t i = 0; i < d.textures.size(); ++i)
    if (const Target* source = targets_.find(textures_.find(call.textures[i])->owner))
      pass_content_ = hash_bytes(&source->held, sizeof source->held, pass_content_);
  ++stats_.draws;
  stats_.instances += call.instance_count;
  const uint64_t triangles = d.topology == Topology::triangles ? call.count / 3 : call.count - 2;
  stats_.triangles += triangles * call.instance_count;
}

}  // namespace tumble
