#include "viewer/render/device_ledger.hpp"

#include "engine/core/hash.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr int largest_side = 16384;
constexpr size_t most_faults = 100;

size_t texel_bytes(TextureFormat f) {
  return f == TextureFormat::r8 || f == TextureFormat::r8_linear_filter ? 1 : 4;
}

bool lies_within(const ScissorRect& part, const TargetDesc& d) {
  return part.x >= 0 && part.y >= 0 && part.width >= 1 && part.height >= 1 &&
         part.x + part.width <= d.width && part.y + part.height <= d.height;
}
bool all_lie_within(std::span<const ScissorRect> parts, const TargetDesc& d) {
  return std::all_of(parts.begin(), parts.end(),
                     [&](const ScissorRect& p) { return lies_within(p, d); });
}

uint64_t pipeline_hash(const PipelineDesc& d) {
  const int32_t states[] = {int(d.topology),    int(d.blend),     int(d.depth_test),
                            int(d.depth_write), int(d.cull),      int(d.colour_write),
                            int(d.stride[0]),   int(d.stride[1]), int(d.alpha_to_coverage)};
  const float bias[] = {d.depth_bias, d.depth_slope_bias};
  uint64_t h = hash_bytes(d.name.data(), d.name.size());
  h = hash_bytes(d.vertex_source.data(), d.vertex_source.size(), h);
  h = hash_bytes(d.fragment_source.data(), d.fragment_source.size(), h);
  return hash_bytes(bias, sizeof bias, hash_bytes(states, sizeof states, h));
}

}  // namespace

void DeviceLedger::fault(std::string sentence) {
  if (faults_.size() < most_faults) faults_.push_back(std::move(sentence));
}

void DeviceLedger::mix(const void* data, size_t size) {
  stats_.hash = hash_bytes(data, size, stats_.hash);
}

BufferId DeviceLedger::add_buffer(BufferUse use, size_t size, std::span<const std::byte> data) {
  if (!data.empty() && data.size() != size) {
    fault(fmt::format("create_buffer of {} bytes with {} bytes of data", size, data.size()));
    return {};
  }
  Buffer b;
  b.use = use;
  b.size = size;
  const BufferId id = buffers_.add(std::move(b));
  if (!data.empty()) update_buffer(id, data);
  return id;
}

bool DeviceLedger::update_buffer(BufferId id, std::span<const std::byte> data) {
  Buffer* b = buffers_.find(id);
  if (!b) {
    fault("update of a buffer that does not exist");
    return false;
  }
  b->size = data.size();
  b->content = hash_bytes(data);
  b->defined = true;
  stats_.uploaded_bytes += data.size();
  if (strict_ && b->use == BufferUse::index) {
    b->indices.resize(data.size() / sizeof(uint32_t));
    if (!b->indices.empty())
      std::memcpy(b->indices.data(), data.data(), b->indices.size() * sizeof(uint32_t));
  }
  return true;
}

TextureId DeviceLedger::add_texture(TextureFormat format, int width, int height,
                                    std::span<const std::byte> data) {
  if (width < 1 || height < 1 || width > largest_side || height > largest_side) {
    fault(fmt::format("create_texture of {} x {} texels", width, height));
    return {};
  }
  const size_t bytes = size_t(width) * size_t(height) * texel_bytes(format);
  if (data.size() != bytes) {
    fault(fmt::format("create_texture of {} bytes with {} bytes of data", bytes, data.size()));
    return {};
  }
  const int32_t size[] = {width, height, int32_t(format)};
  Texture t;
  t.width = width;
  t.height = height;
  t.content = hash_bytes(data, hash_bytes(size, sizeof size));
  stats_.uploaded_bytes += bytes;
  return textures_.add(std::move(t));
}

PipelineId DeviceLedger::add_pipeline(const PipelineDesc& desc) {
  if (desc.textures.size() > DrawCall{}.textures.size() || desc.uniform_blocks.size() > 2) {
    fault("pipeline " + desc.name + " with more than 6 textures or 2 uniform blocks");
    return {};
  }
  for (const Attribute& a : desc.attributes)
    if (a.slot > 1 || a.components < 1 || a.components > 4 || desc.stride[a.slot] == 0) {
      fault(fmt::format("pipeline {}: attribute {} is malformed", desc.name, a.location));
      return {};
    }
  Pipeline p{desc, pipeline_hash(desc), 0};
  p.desc.vertex_source.clear();
  p.desc.fragment_source.clear();
  return pipelines_.add(std::move(p));
}

TargetId DeviceLedger::add_target(const TargetDesc& desc) {
  if (desc.width < 1 || desc.height < 1 || desc.width > largest_side ||
      desc.height > largest_side) {
    fault(fmt::format("create_target of {} x {} pixels", desc.width, desc.height));
    return {};
  }
  Target t;
  t.desc = desc;
  const TargetId id = targets_.add(t);
  Target& made = *targets_.find(id);
  const auto texture = [&](bool compares) {
    Texture x;
    x.width = desc.width;
    x.height = desc.height;
    x.owner = id;
    x.compares = compares;
    const int32_t size[] = {desc.width, desc.height, int32_t(compares)};
    x.content = hash_bytes(size, sizeof size);  // what is drawn into it is in the hash already
    return textures_.add(std::move(x));
  };
  if (desc.samples == 1 && desc.colour != ColourAttachment::none) made.colour = texture(false);
  if (desc.depth == DepthAttachment::texture || desc.depth == DepthAttachment::shadow_texture)
    made.depth = texture(desc.depth == DepthAttachment::shadow_texture);
  return id;
}

bool DeviceLedger::remove(TextureId id) {
  const Texture* t = textures_.find(id);
  if (t && t->owner) {
    fault("destroy of a texture that belongs to a target");
    return false;
  }
  return remove_from(textures_, id, "texture");
}

bool DeviceLedger::remove(TargetId id) {
  const Target* t = targets_.find(id);
  if (t && id == current_) {
    fault("destroy of the target being drawn into");
    return false;
  }
  if (t) {
    if (t->colour) textures_.remove(t->colour);
    if (t->depth) textures_.remove(t->depth);
  }
  return remove_from(targets_, id, "target");
}

void DeviceLedger::begin_frame() {
  if (current_) fault("begin_frame inside a pass");
  stats_ = {};
}

bool DeviceLedger::begin_pass(const PassDesc& pass) {
  const Target* t = targets_.find(pass.target);
  if (current_) fault("begin_pass inside a pass");
  if (!t) fault("begin_pass on a target that does not exist");
  if (current_ || !t) return false;
  current_ = pass.target;
  ++stats_.passes;
  const Target* averaged = targets_.find(pass.averages);
  const Target* nearest = targets_.find(pass.depth_of);
  if ((pass.averages && !check_average(pass, averaged, t)) ||
      (pass.depth_of && !check_depth(pass, nearest, t)))
    return std::exchange(current_, {}), false;
  const int32_t shape[] = {t->desc.width,       t->desc.height,     t->desc.samples,
                           int(t->desc.colour), int(t->desc.depth), int(pass.clear_depth)};
  mix(shape);
  if (pass.clear_colour) mix(*pass.clear_colour);
  depth_is_fresh_ = pass.clear_depth || t->desc.depth == DepthAttachment::none;
  const bool all = depth_is_fresh_ &&
                   (pass.clear_colour || averaged || t->desc.colour == ColourAttachment::none);
  pass_content_ = hash_bytes(shape, sizeof shape, all ? 1 : t->held);
  if (averaged) take_from(*averaged, pass.averaged_parts);
  if (nearest) take_from(*nearest, pass.depth_parts);
  depth_is_fresh_ &= !nearest;
  if (pass.clear_colour)
    pass_content_ = hash_bytes(&*pass.clear_colour, sizeof *pass.clear_colour, pass_content_);
  return true;
}

void DeviceLedger::take_from(const Target& from, std::span<const ScissorRect> parts) {
  mix(from.desc.samples);
  const auto bytes = std::as_bytes(parts);
  mix(bytes.data(), bytes.size());
  pass_content_ = hash_bytes(bytes, pass_content_);
  pass_content_ = hash_bytes(&from.held, sizeof from.held, pass_content_);
}

bool DeviceLedger::end_pass() {
  if (!current_)
    fault("end_pass without begin_pass");
  else
    note_content(targets_.find(current_)->held, pass_content_);
  return std::exchange(current_, {}).value != 0;
}

bool DeviceLedger::check_average(const PassDesc& pass, const Target* from, const Target* to) {
  const char* wrong = nullptr;
  if (!from)
    wrong = "a target that does not exist";
  else if (from == to)
    wrong = "the target itself";
  else if (from->desc.width != to->desc.width || from->desc.height != to->desc.height)
    wrong = "a target of another size";
  else if (from->desc.colour == ColourAttachment::none || !to->colour)
    wrong = "a target without colour";
  else if (pass.averaged_parts.empty() || !all_lie_within(pass.averaged_parts, to->desc))
    wrong = "no part, or one outside the target";
  if (wrong) fault(std::string("begin_pass with the average of ") + wrong);
  return !wrong;
}

bool DeviceLedger::check_depth(const PassDesc& pass, const Target* from, const Target* to) {
  const char* wrong = nullptr;
  if (!from)
    wrong = "a target that does not exist";
  else if (from == to)
    wrong = "the target itself";
  else if (from->desc.width != to->desc.width || from->desc.height != to->desc.height)
    wrong = "a target of another size";
  else if (from->desc.depth == DepthAttachment::none || !to->depth || !pass.clear_depth)
    wrong = "a target without depth, or into one that keeps its own";
  else if (!all_lie_within(pass.depth_parts, to->desc))
    wrong = "a part outside the target";
  if (wrong) fault(std::string("begin_pass with the depth of ") + wrong);
  return !wrong;
}

bool DeviceLedger::check_resolve(const Target* from, const Target* to) {
  const char* wrong = nullptr;
  if (current_)
    wrong = "inside a pass";
  else if (!from || !to)
    wrong = "of a target that does not exist";
  else if (from->desc.width != to->desc.width || from->desc.height != to->desc.height)
    wrong = "between sizes";
  if (wrong) fault(std::string("resolve ") + wrong);
  return !wrong;
}

bool DeviceLedger::resolve(TargetId from, TargetId to) {
  const Target* a = targets_.find(from);
  Target* b = targets_.find(to);
  if (!check_resolve(a, b)) return false;
  if (!b->colour || a->desc.colour == ColourAttachment::none) {
    fault("resolve without colour");
    return false;
  }
  note_content(b->held, a->held ? hash_bytes(&a->held, sizeof a->held) : 0);
  return true;
}

void DeviceLedger::note_content(uint64_t& held, uint64_t content) {
  kept_ = content != 0 && held == content;
  stats_.kept += kept_;
  held = content;
}

void DeviceLedger::forget_contents() {
  targets_.for_each([](Target& t) { t.held = 0; });
}

bool DeviceLedger::read_pixels(TargetId target, size_t bytes) {
  const Target* t = targets_.find(target);
  const char* wrong = nullptr;
  if (current_)
    wrong = "inside a pass";
  else if (!t)
    wrong = "of a target that does not exist";
  else if (!t->colour)
    wrong = "of a target without a colour texture";
  else if (bytes != size_t(t->desc.width) * size_t(t->desc.height) * 4)
    wrong = "into a wrong size";
  if (wrong) fault(std::string("read_pixels ") + wrong);
  return !wrong;
}

bool DeviceLedger::present(TargetId target) {
  const Target* t = targets_.find(target);
  const bool good = !current_ && t && t->colour;
  if (!good) fault("present of a target that does not exist, has many samples, or in a pass");
  return good;
}

DrawStats DeviceLedger::stats() const {
  DrawStats s = stats_;
  s.live_resources = buffers_.live() + textures_.live() + pipelines_.live() + targets_.live();
  return s;
}

}  // namespace tumble
