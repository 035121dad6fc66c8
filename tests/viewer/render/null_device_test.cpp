// The validating device. Reference: a list of misuses, each of which must be reported by a
// sentence, beside the correct use, which must not.
#include "viewer/render/null/null_device.hpp"

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// A device with one of everything, used rightly.
struct Bench {
  std::unique_ptr<Device> device = make_null_device();
  PipelineDesc desc;
  PipelineId pipeline;
  TargetId target, depth_only, many;
  TextureId texture;
  BufferId vertices, instances, indices, uniforms;

  Bench() {
    desc.name = std::string("pipeline");
    desc.attributes = {{0, 0, AttributeType::f32, 3, 0}, {1, 1, AttributeType::f32, 4, 0}};
    desc.stride = {12, 16};
    desc.textures = {"t"};
    desc.uniform_blocks = {"Frame"};
    pipeline = *device->create_pipeline(desc);
    TargetDesc t;
    t.width = t.height = 8;
    target = *device->create_target(t);
    t.samples = 4;
    many = *device->create_target(t);
    t.samples = 1;
    t.colour = ColourAttachment::none;
    t.depth = DepthAttachment::texture;
    depth_only = *device->create_target(t);
    texture = device->create_texture(TextureFormat::r8, 2, 2, bytes(4));
    vertices = device->create_buffer(BufferUse::vertex, 36, bytes(36));
    instances = device->create_buffer(BufferUse::vertex, 32, bytes(32));
    const std::array<uint32_t, 3> triangle = {0, 1, 2};
    indices = device->create_buffer(BufferUse::index, 12, std::as_bytes(std::span(triangle)));
    uniforms = device->create_buffer(BufferUse::uniform, 512, bytes(512));
  }

  static std::span<const std::byte> bytes(size_t n) {
    static const std::vector<std::byte> zeros(4096);
    return {zeros.data(), n};
  }
  DrawCall call() const {
    DrawCall c;
    c.pipeline = pipeline;
    c.vertices = vertices;
    c.instances = instances;
    c.indices = indices;
    c.count = 3;
    c.instance_count = 2;
    c.textures[0] = texture;
    c.uniforms[0] = {uniforms, 256, 256};
    return c;
  }
  /// Faults of one draw in a pass of its own.
  std::vector<std::string> faults_of(const DrawCall& c, TargetId into) const {
    device->begin_pass({into, {}, true});
    device->draw(c);
    device->end_pass();
    return device->take_faults();
  }
  size_t faults_of(const DrawCall& c) const { return faults_of(c, target).size(); }
};

}  // namespace

TEST_CASE("right use is accepted and counted") {
  Bench b;
  b.device->begin_frame();
  CHECK(b.faults_of(b.call()) == 0);
  const DrawStats s = b.device->stats();
  CHECK(s.passes == 1);
  CHECK(s.draws == 1);
  CHECK(s.instances == 2);
  CHECK(s.triangles == 2);
  CHECK(s.hash != 0);
  b.device->resolve(b.many, b.target);
  std::vector<uint8_t> pixels(8 * 8 * 4);
  b.device->read_pixels(b.target, pixels);
  b.device->present(b.target);
  CHECK(b.device->take_faults().empty());
}

TEST_CASE("misuse of a draw is reported") {
  Bench b;
  std::vector<std::pair<const char*, DrawCall>> wrongs;
  const auto wrong = [&](const char* what, auto change) {
    DrawCall c = b.call();
    change(c);
    wrongs.emplace_back(what, c);
  };
  wrong("no pipeline", [](DrawCall& c) { c.pipeline = {}; });
  wrong("nothing to draw", [](DrawCall& c) { c.count = 0; });
  wrong("no instance", [](DrawCall& c) { c.instance_count = 0; });
  wrong("no vertices", [](DrawCall& c) { c.vertices = {}; });
  wrong("no instances", [](DrawCall& c) { c.instances = {}; });
  wrong("indices as vertices", [](DrawCall& c) { c.vertices = c.indices; });
  wrong("vertices as indices", [](DrawCall& c) { c.indices = c.vertices; });
  wrong("too many instances", [](DrawCall& c) { c.instance_count = 3; });
  wrong("instances from too far on", [](DrawCall& c) { c.instance_offset = 16; });
  wrong("too many indices", [](DrawCall& c) { c.count = 6; });
  wrong("index beyond the vertices", [](DrawCall& c) { c.base_vertex = 1; });
  wrong("index before the vertices", [](DrawCall& c) { c.base_vertex = -1; });
  wrong("no texture", [](DrawCall& c) { c.textures[0] = {}; });
  wrong("no uniforms", [](DrawCall& c) { c.uniforms[0] = {}; });
  wrong("uniforms off the grid", [](DrawCall& c) { c.uniforms[0].offset = 4; });
  wrong("uniforms beyond the end", [](DrawCall& c) { c.uniforms[0].size = 257; });
  wrong("scissor outside", [](DrawCall& c) { c.scissor = ScissorRect{4, 4, 5, 4}; });
  wrong("empty scissor", [](DrawCall& c) { c.scissor = ScissorRect{4, 4, 0, 4}; });
  wrong("texture of the target itself",
        [&](DrawCall& c) { c.textures[0] = b.device->colour_texture(b.target); });
  for (const auto& wrong_call : wrongs) {
    CAPTURE(wrong_call.first);
    CHECK(b.faults_of(wrong_call.second) == 1);
  }
  CHECK(b.faults_of(b.call(), b.depth_only).size() == 1);  // writes colour
  CHECK(b.faults_of(b.call()) == 0);
}

TEST_CASE("misuse of passes is reported") {
  Bench b;
  const auto faults = [&] { return b.device->take_faults().size(); };
  b.device->draw(b.call());
  CHECK(faults() == 1);
  b.device->end_pass();
  CHECK(faults() == 1);
  b.device->begin_pass({{}, {}, true});
  CHECK(faults() == 1);
  b.device->begin_pass({b.target, {}, true});
  b.device->begin_pass({b.target, {}, true});
  CHECK(faults() == 1);
  b.device->resolve(b.many, b.target);
  b.device->present(b.target);
  b.device->destroy(b.target);
  b.device->begin_frame();
  CHECK(faults() == 4);
  b.device->end_pass();
  CHECK(faults() == 0);
  std::vector<uint8_t> few(4);
  b.device->read_pixels(b.target, few);
  b.device->read_pixels(b.depth_only, few);
  b.device->present(b.many);
  CHECK(faults() == 3);
}

TEST_CASE(
    "a draw over the whole target covers colours that were drawn before it, not their depth") {
  Bench b;
  b.desc.name = "cover";
  b.desc.covers_target = true;
  b.desc.depth_test = DepthTest::none;
  b.desc.depth_write = false;
  const PipelineId cover = *b.device->create_pipeline(b.desc);
  const auto kept = [&](PipelineId first, uint32_t instances) {
    DrawCall c = b.call();
    b.device->begin_frame();
    b.device->begin_pass({b.target, std::array<float, 4>{0, 0, 0, 1}, true});
    c.pipeline = first;
    c.instance_count = instances;
    b.device->draw(c);
    c = b.call();
    c.pipeline = cover;
    b.device->draw(c);
    b.device->end_pass();
    return b.device->stats().kept == 1;
  };
  CHECK_FALSE(kept(cover, 1));
  CHECK(kept(cover, 2));
  CHECK_FALSE(kept(b.pipeline, 1));
  CHECK_FALSE(kept(b.pipeline, 2));
  CHECK(kept(b.pipeline, 2));
  b.device->forget_contents();
  CHECK_FALSE(kept(b.pipeline, 2));
  CHECK(b.device->take_faults().empty());
}

TEST_CASE("a pass that begins with the average of a target depends on what that holds") {
  Bench b;
  const auto faults = [&] { return b.device->take_faults().size(); };
  const auto begin = [&](TargetId from, std::vector<ScissorRect> parts) {
    PassDesc pass{b.target, std::array<float, 4>{0, 0, 0, 1}, true};
    pass.averages = from;
    pass.averaged_parts = std::move(parts);
    b.device->begin_pass(pass);
    const size_t wrong = faults();
    b.device->end_pass();
    return wrong + faults();
  };
  const ScissorRect part{2, 0, 3, 8};
  const ScissorRect outside{2, 0, 7, 8};
  CHECK(begin(b.many, {part}) == 0);
  CHECK(begin(b.many, {part, outside}) == 2);  // and then no pass is open
  CHECK(begin(b.many, {}) == 2);
  CHECK(begin(b.target, {part}) == 2);
  CHECK(begin(b.depth_only, {part}) == 2);
  TargetDesc other;
  other.width = 9;
  other.height = 8;
  CHECK(begin(*b.device->create_target(other), {part}) == 2);

  const auto kept = [&](uint32_t instances, std::vector<ScissorRect> parts) {
    DrawCall c = b.call();
    c.instance_count = instances;
    b.device->begin_frame();
    b.device->begin_pass({b.many, std::array<float, 4>{0, 0, 0, 1}, true});
    b.device->draw(c);
    b.device->end_pass();
    CHECK(begin(b.many, std::move(parts)) == 0);
    return b.device->stats().kept;
  };
  kept(1, {part});
  CHECK(kept(1, {part}) == 2);
  CHECK(kept(2, {part}) == 0);
  CHECK(kept(2, {part}) == 2);
  CHECK(kept(2, {{2, 0, 4, 8}}) == 1);
  CHECK(kept(2, {part, {5, 0, 1, 8}}) == 1);
}

TEST_CASE("a pass that begins with the depth of a target depends on what that holds") {
  Bench b;
  TargetDesc desc;
  desc.width = desc.height = 8;
  desc.colour = ColourAttachment::none;
  desc.depth = DepthAttachment::texture;
  const TargetId to = *b.device->create_target(desc);
  const auto faults = [&] { return b.device->take_faults().size(); };
  const auto begin = [&](TargetId from, std::vector<ScissorRect> parts, bool clear_depth = true) {
    PassDesc pass{to, {}, clear_depth};
    pass.depth_of = from;
    pass.depth_parts = std::move(parts);
    b.device->begin_pass(pass);
    const size_t wrong = faults();
    b.device->end_pass();
    return wrong + faults();
  };
  const ScissorRect part{2, 0, 3, 8};
  const ScissorRect outside{2, 0, 7, 8};
  CHECK(begin(b.many, {part}) == 0);
  CHECK(begin(b.many, {}) == 0);
  CHECK(begin(b.many, {part, outside}) == 2);  // and then no pass is open
  CHECK(begin(b.many, {part}, false) == 2);
  CHECK(begin(to, {part}) == 2);
  desc.width = 9;
  CHECK(begin(*b.device->create_target(desc), {part}) == 2);

  const auto kept = [&](uint32_t instances, std::vector<ScissorRect> parts) {
    DrawCall c = b.call();
    c.instance_count = instances;
    b.device->begin_frame();
    b.device->begin_pass({b.many, std::array<float, 4>{0, 0, 0, 1}, true});
    b.device->draw(c);
    b.device->end_pass();
    CHECK(begin(b.many, std::move(parts)) == 0);
    return b.device->stats().kept;
  };
  kept(1, {part});
  CHECK(kept(1, {part}) == 2);
  CHECK(kept(2, {part}) == 0);
  CHECK(kept(2, {part}) == 2);
  CHECK(kept(2, {part, part}) == 1);
  CHECK(kept(2, {}) == 1);
  CHECK(kept(2, {}) == 2);
}

TEST_CASE("stale and foreign ids are found out, and leaks are counted") {
  Bench b;
  const uint32_t live = b.device->stats().live_resources;
  CHECK(live == 11);  // a pipeline, three targets with two textures, a texture, four buffers
  const BufferId old = b.vertices;
  b.device->destroy(old);
  b.vertices = b.device->create_buffer(BufferUse::vertex, 36, Bench::bytes(36));
  CHECK(b.device->take_faults().empty());
  DrawCall c = b.call();
  c.vertices = old;
  CHECK(b.faults_of(c) == 1);
  b.device->destroy(old);
  b.device->update_buffer(old, Bench::bytes(4));
  b.device->destroy(b.device->colour_texture(b.target));
  CHECK(b.device->take_faults().size() == 3);
  for (const TargetId t : {b.target, b.many, b.depth_only}) b.device->destroy(t);
  for (const BufferId i : {b.vertices, b.instances, b.indices, b.uniforms}) b.device->destroy(i);
  b.device->destroy(b.texture);
  b.device->destroy(b.pipeline);
  CHECK(b.device->take_faults().empty());
  CHECK(b.device->stats().live_resources == 0);
}

TEST_CASE("malformed resources are refused") {
  auto device = make_null_device();
  CHECK_FALSE(device->create_buffer(BufferUse::vertex, 8, Bench::bytes(4)));
  CHECK_FALSE(device->create_texture(TextureFormat::rgba8, 2, 2, Bench::bytes(15)));
  CHECK_FALSE(device->create_texture(TextureFormat::r8, 0, 2, {}));
  TargetDesc t;
  t.width = 20000;
  t.height = 1;
  CHECK_FALSE(device->create_target(t).ok());
  PipelineDesc p;
  p.attributes = {{0, 0, AttributeType::f32, 3, 0}};  // without a stride
  CHECK_FALSE(device->create_pipeline(p).ok());
}

TEST_CASE("the draw-list hash sees what decides a picture, and only that") {
  const auto hash_of = [](auto change) {
    Bench b;
    b.device->begin_frame();
    DrawCall c = b.call();
    change(b, c);
    CHECK(b.faults_of(c) == 0);
    return b.device->stats().hash;
  };
  const uint64_t base = hash_of([](Bench&, DrawCall&) {});
  CHECK(base == hash_of([](Bench&, DrawCall&) {}));
  // Other ids, same contents.
  CHECK(base == hash_of([](Bench& b, DrawCall& c) {
          c.vertices = b.device->create_buffer(BufferUse::vertex, 36, Bench::bytes(36));
        }));
  CHECK(base != hash_of([](Bench&, DrawCall& c) { c.instance_count = 1; }));
  CHECK(base != hash_of([](Bench&, DrawCall& c) { c.scissor = ScissorRect{0, 0, 4, 4}; }));
  CHECK(base != hash_of([](Bench& b, DrawCall&) {
          std::array<float, 8> other{1};
          b.device->update_buffer(b.instances, std::as_bytes(std::span(other)));
        }));
  CHECK(base != hash_of([](Bench& b, DrawCall& c) {
          b.desc.name = std::string("another");
          c.pipeline = *b.device->create_pipeline(b.desc);
        }));
}
