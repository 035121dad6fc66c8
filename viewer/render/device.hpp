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

// The narrow waist between the renderer and a graphics library. Two implementations: gl/ (OpenGL
// 3.3 core) and null/ (draws nothing, checks everything). A Device belongs to one thread.

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
/// The alpha of a target is what is left to see of what lies under it: 1 where nothing has been
/// drawn, 0 under what is opaque. (The other way round, coverage of samples by alpha would leave
/// its own value there.) What is drawn says by its alpha how much it covers, except with `none`,
/// which stores it.
enum class Blend : uint8_t {
  none,
  alpha,
  premultiplied,
  add,       ///< what is drawn and what was there
  multiply,  ///< what was there, times what is drawn
  under,     ///< what was there, over what is drawn, which is opaque
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
  bool alpha_to_coverage = false;  ///< leaves nothing where it covers
  bool covers_target = false;      ///< every draw replaces the colour of the whole target
  float depth_bias = 0;            ///< in depth steps (polygon offset units)
  float depth_slope_bias = 0;      ///< times the depth slope
};

enum class ColourAttachment : uint8_t {
  none,
  rgba8,
  r8,
  r32f,     ///< numbers of any size, such as distances
  rgba16f,  ///< sums
};
enum class DepthAttachment : uint8_t {
  none,
  buffer,          ///< needed while drawing only
  texture,         ///< sampled as plain depth
  shadow_texture,  ///< sampled with comparison and linear filter
};

struct TargetDesc {
  int width = 0, height = 0;
  int samples = 1;  ///< reduced to what the device has; 1: colour is a texture
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
  /// Then its colour is that of another target of the same size, its samples averaged, in these
  /// parts, at least one.
  TargetId averages{};
  std::vector<ScissorRect> averaged_parts{};
  /// Then its depth, cleared, is in these parts that of one sample of another target of the same
  /// size.
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

/// What was asked of the device since begin_frame(). The hash covers everything that decides the
/// picture (pipelines by name, contents of buffers and textures, order, counts, states) and is the
/// same on every device.
struct DrawStats {
  uint64_t hash = 0;
  uint32_t passes = 0;
  uint32_t kept = 0;  ///< passes and resolves whose outcome the target held already: not done anew
  uint32_t draws = 0;
  uint64_t instances = 0;
  uint64_t triangles = 0;
  uint64_t uploaded_bytes = 0;
  uint32_t live_resources = 0;  ///< buffers, textures, pipelines and targets not yet destroyed
};

/// What is drawn in a pass may be put off until its end: a pass that would leave its target as it
/// is (same draws, same contents, after a clear of all that the target has) is counted and hashed,
/// but not done again. So what stands still costs nothing, and pictures are what they would be.
class Device {
 public:
  virtual ~Device() = default;

  virtual const DeviceInfo& info() const = 0;

  /// `data` may be empty: contents undefined until update_buffer.
  virtual BufferId create_buffer(BufferUse use, size_t size, std::span<const std::byte> data) = 0;
  /// Replaces the whole contents, growing or shrinking the buffer.
  virtual void update_buffer(BufferId buffer, std::span<const std::byte> data) = 0;
  virtual TextureId create_texture(TextureFormat format, int width, int height,
                                   std::span<const std::byte> data) = 0;
  /// Fails with the compiler's log, the pipeline's name as place. Linked when first drawn with: see
  /// take_link_failure().
  virtual Result<PipelineId> create_pipeline(const PipelineDesc& desc) = 0;
  /// Fails when the size is beyond the device or memory.
  virtual Result<TargetId> create_target(const TargetDesc& desc) = 0;
  /// The colour or depth texture of a target of one sample, for drawing with; owned by the target.
  virtual TextureId colour_texture(TargetId target) = 0;
  virtual TextureId depth_texture(TargetId target) = 0;

  virtual void destroy(BufferId id) = 0;
  virtual void destroy(TextureId id) = 0;
  virtual void destroy(PipelineId id) = 0;
  virtual void destroy(TargetId id) = 0;

  /// Starts a frame: counters and hash begin anew.
  virtual void begin_frame() = 0;
  virtual void begin_pass(const PassDesc& pass) = 0;
  virtual void draw(const DrawCall& call) = 0;
  virtual void end_pass() = 0;
  /// Copies colour, averaging samples; equal sizes, outside a pass.
  virtual void resolve(TargetId from, TargetId to) = 0;
  /// RGBA rows, top row first, of a target of one sample; waits for the drawing to end.
  virtual void read_pixels(TargetId target, std::span<uint8_t> rgba) = 0;
  /// Copies a target of one sample to the window's own framebuffer, top left aligned.
  virtual void present(TargetId target) = 0;

  /// What is in the targets may be lost, as over a suspend or on another console: every pass is
  /// drawn anew.
  virtual void forget_contents() = 0;

  virtual DrawStats stats() const = 0;
  /// Misuse and driver errors since the last call, as sentences; empty when all is well.
  virtual std::vector<std::string> take_faults() = 0;
  /// The first failure of linking among the pipelines drawn with since the last call, the name of
  /// one as place: what they draw is missing, everything else is there.
  virtual Status take_link_failure() = 0;
};

}  // namespace tumble
