#pragma once
#include "engine/core/result.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

// The narrow interface between the renderer and a graphics library. There are two implementations:
// gl/ (OpenGL 3.3 core) and null/ (draws nothing, checks everything). A Device belongs to one
// thread.

/// Ids are opaque; 0 is none. A stale id is reported, never followed.
template <class Tag>
struct DeviceId {
  uint32_t value = 0;
  explicit operator bool() const { return value != 0; }
  bool operator==(const DeviceId&) const = default;
};
using BufferId = DeviceId<struct BufferTag>;
using TextureId = DeviceId<struct TextureTag>;
using PipelineId = DeviceId<struct PipelineTag>;
using TargetId = DeviceId<struct TargetTag>;

enum class BufferUse : uint8_t { vertex, index, uniform };
enum class TextureFormat : uint8_t { r8, rgba8, rgba8_linear_filter, r8_linear_filter };
enum class Topology : uint8_t { triangles, triangle_strip };
/// How a fragment is combined with its target. The alpha of a target is its transmittance: 1 where
/// nothing has been drawn, 0 under opaque surfaces. (If it were opacity, alpha to coverage would
/// write its own alpha there.) The alpha of a fragment is its opacity, except with `none`, which
/// stores it unchanged.
enum class Blend : uint8_t {
  none,
  alpha,
  premultiplied,
  add,       ///< adds the fragment to the target
  multiply,  ///< multiplies the target by the fragment
  under,     ///< puts an opaque fragment under the target, by the target's transmittance
};
enum class DepthTest : uint8_t { none, less_equal, greater };
enum class Cull : uint8_t { none, back, front };
enum class AttributeType : uint8_t { f32, u8_unorm, u32 };

struct DeviceInfo {
  std::string name;      ///< "gl" or "null"
  std::string renderer;  ///< as the driver says: "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string version;
  bool software = false;
  int max_texture_size = 0;
  int max_samples = 1;
};

/// One vertex input: `location` in the shader, from slot 0 (vertices) or 1 (per instance).
struct Attribute {
  uint8_t location = 0;
  uint8_t slot = 0;
  AttributeType type = AttributeType::f32;
  uint8_t components = 3;
  uint16_t offset = 0;
};

struct PipelineDesc {
  std::string name;  ///< for messages and the draw-list hash
  std::string vertex_source;
  std::string fragment_source;
  std::vector<Attribute> attributes;
  std::array<uint16_t, 2> stride{};   ///< bytes from one vertex (slot 0) or instance (slot 1) on
  std::vector<std::string> textures;  ///< sampler names, in the order of DrawCall::textures
  std::vector<std::string> uniform_blocks;  ///< block names, in the order of DrawCall::uniforms
  Topology topology = Topology::triangles;
  Blend blend = Blend::none;
  DepthTest depth_test = DepthTest::less_equal;
  bool depth_write = true;
  Cull cull = Cull::back;
  bool colour_write = true;
  bool alpha_to_coverage = false;  ///< covered samples get transmittance 0
  bool covers_target = false;      ///< every draw replaces the colour of the whole target
  float depth_bias = 0;            ///< in depth steps (polygon offset units)
  float depth_slope_bias = 0;      ///< times the depth slope
};

enum class ColourAttachment : uint8_t {
  none,
  rgba8,
  r8,
  r32f,     ///< unbounded numbers such as distances
  rgba16f,  ///< for accumulated sums
};
enum class DepthAttachment : uint8_t {
  none,
  buffer,          ///< needed only while drawing (renderbuffer)
  texture,         ///< sampled as plain depth
  shadow_texture,  ///< sampled with comparison and linear filter
};

struct TargetDesc {
  int width = 0, height = 0;
  int samples = 1;  ///< at most what the device supports is used; with 1 the colour is a texture
  ColourAttachment colour = ColourAttachment::rgba8;
  DepthAttachment depth = DepthAttachment::buffer;
};

/// Pixels from the top left of the target; half open.
struct ScissorRect {
  int x = 0, y = 0, width = 0, height = 0;
};

struct PassDesc {
  TargetId target;
  std::optional<std::array<float, 4>> clear_colour;
  bool clear_depth = true;
  /// If set, the pass begins with the colour of this other target of the same size, its samples
  /// averaged, in `averaged_parts` (at least one).
  TargetId averages{};
  std::vector<ScissorRect> averaged_parts{};
  /// If set, the pass clears the depth and then takes it, in `depth_parts`, from one sample of this
  /// other target of the same size.
  TargetId depth_of{};
  std::vector<ScissorRect> depth_parts{};
};

struct UniformRange {
  BufferId buffer;
  uint32_t offset = 0;  ///< a multiple of 256
  uint32_t size = 0;
};

struct DrawCall {
  PipelineId pipeline;
  BufferId vertices;
  BufferId instances;
  uint32_t instance_offset = 0;  ///< bytes into `instances`
  BufferId indices;              ///< 32-bit; none: vertices in order
  uint32_t first = 0;            ///< first index, or first vertex
  uint32_t count = 0;            ///< indices or vertices of one instance
  int32_t base_vertex = 0;       ///< added to each index
  uint32_t instance_count = 1;
  std::array<TextureId, 6> textures{};
  std::array<UniformRange, 2> uniforms{};
  std::optional<ScissorRect> scissor;
};

/// Work requested of the device since begin_frame(). The hash covers everything that decides the
/// picture (pipelines by name, contents of buffers and textures, order, counts, states) and is the
/// same on every device.
struct DrawStats {
  uint64_t hash = 0;
  uint32_t passes = 0;
  /// Passes and resolves that were skipped because the target already had their result.
  uint32_t kept = 0;
  uint32_t draws = 0;
  uint64_t instances = 0;
  uint64_t triangles = 0;
  uint64_t uploaded_bytes = 0;
  uint32_t live_resources = 0;  ///< buffers, textures, pipelines and targets not yet destroyed
};

/// The draws of a pass may be deferred to its end. A pass whose target already has its result (a
/// clear of everything in the target, then the same draws with the same contents) is counted and
/// hashed, but not drawn again. Still pictures thus cost nothing, and the pixels are the same
/// either way.
class Device {
 public:
  virtual ~Device() = default;

  virtual const DeviceInfo& info() const = 0;

  /// `data` may be empty; the contents are then undefined until update_buffer.
  virtual BufferId create_buffer(BufferUse use, size_t size, std::span<const std::byte> data) = 0;
  /// Replaces the whole contents, growing or shrinking the buffer.
  virtual void update_buffer(BufferId buffer, std::span<const std::byte> data) = 0;
  virtual TextureId create_texture(TextureFormat format, int width, int height,
                                   std::span<const std::byte> data) = 0;
  /// Fails if the description is malformed. Its shaders are compiled and linked at the first draw:
  /// see take_link_failure().
  virtual Result<PipelineId> create_pipeline(const PipelineDesc& desc) = 0;
  /// Fails when the size exceeds the limits of the device or its memory.
  virtual Result<TargetId> create_target(const TargetDesc& desc) = 0;
  /// The colour or depth texture of a single-sampled target, to be sampled by draws; owned by the
  /// target.
  virtual TextureId colour_texture(TargetId target) = 0;
  virtual TextureId depth_texture(TargetId target) = 0;

  virtual void destroy(BufferId id) = 0;
  virtual void destroy(TextureId id) = 0;
  virtual void destroy(PipelineId id) = 0;
  virtual void destroy(TargetId id) = 0;

  /// Starts a frame: resets the counters and the hash.
  virtual void begin_frame() = 0;
  virtual void begin_pass(const PassDesc& pass) = 0;
  virtual void draw(const DrawCall& call) = 0;
  virtual void end_pass() = 0;
  /// Copies the colour, averaging samples, to a target of the same size. Must be called outside a
  /// pass.
  virtual void resolve(TargetId from, TargetId to) = 0;
  /// The pixels of a single-sampled target as RGBA rows, top row first. Waits until drawing has
  /// finished.
  virtual void read_pixels(TargetId target, std::span<uint8_t> rgba) = 0;
  /// Copies a single-sampled target to the window's framebuffer, aligned at the top left.
  virtual void present(TargetId target) = 0;

  /// To be called when the contents of the targets may be lost, e.g. after a suspend or a switch of
  /// the console: every later pass is drawn anew.
  virtual void forget_contents() = 0;

  virtual DrawStats stats() const = 0;
  /// Misuse and driver errors since the last call, as sentences; empty if there were none.
  virtual std::vector<std::string> take_faults() = 0;
  /// The first failure of compiling or linking among the pipelines drawn with since the last call,
  /// with the driver's log; the place of the error is that pipeline's name. Draws with such
  /// pipelines are missing from the picture, all others are drawn.
  virtual Status take_link_failure() = 0;
};

}  // namespace tumble
