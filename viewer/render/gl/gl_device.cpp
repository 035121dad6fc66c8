#include "viewer/render/gl/gl_device.hpp"

#include "viewer/render/device_ledger.hpp"
#include "viewer/render/gl/average.hpp"
#include "viewer/render/gl/functions.hpp"
#include "viewer/render/gl/program.hpp"
#include "viewer/render/gl/target.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

GLenum target_of(BufferUse use) {
  return use == BufferUse::vertex  ? GL_ARRAY_BUFFER
         : use == BufferUse::index ? GL_ELEMENT_ARRAY_BUFFER
                                   : GL_UNIFORM_BUFFER;
}

class GlDevice final : public Device {
 public:
  GlDevice(const GlFunctions& functions, const ContextInfo& context)
      : gl_(functions), programs_(gl_), average_(gl_, programs_), ledger_(false) {
    info_.name = "gl";
    info_.renderer = context.renderer;
    info_.version = context.version;
    info_.software = context.software;
    gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &info_.max_texture_size);
    gl_.GetIntegerv(GL_MAX_SAMPLES, &info_.max_samples);
    gl_.GenVertexArrays(1, &vertex_array_);
    gl_.BindVertexArray(vertex_array_);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  }
  ~GlDevice() override { gl_.DeleteVertexArrays(1, &vertex_array_); }

  const DeviceInfo& info() const override { return info_; }

  BufferId create_buffer(BufferUse use, size_t size, std::span<const std::byte> data) override {
    const BufferId id = ledger_.add_buffer(use, size, data);
    if (auto* b = ledger_.find(id)) {
      gl_.GenBuffers(1, &b->native);
      upload(*b, size, data.empty() ? nullptr : data.data());
    }
    return id;
  }
  void update_buffer(BufferId id, std::span<const std::byte> data) override {
    draw_put_off();
    if (!ledger_.update_buffer(id, data)) return;
    upload(*ledger_.find(id), data.size(), data.data());
  }
  TextureId create_texture(TextureFormat format, int width, int height,
                           std::span<const std::byte> data) override;
  Result<PipelineId> create_pipeline(const PipelineDesc& desc) override;
  Result<TargetId> create_target(const TargetDesc& desc) override;
  TextureId colour_texture(TargetId id) override {
    const auto* t = ledger_.find(id);
    return t ? t->colour : TextureId{};
  }
  TextureId depth_texture(TargetId id) override {
    const auto* t = ledger_.find(id);
    return t ? t->depth : TextureId{};
  }

  void destroy(BufferId id) override {
    draw_put_off();
    if (const auto* b = ledger_.find(id)) gl_.DeleteBuffers(1, &b->native);
    ledger_.remove(id);
  }
  void destroy(TextureId id) override {
    draw_put_off();
    const auto* t = ledger_.find(id);
    const GLuint native = t ? t->native : 0;
    if (ledger_.remove(id)) gl_.DeleteTextures(1, &native);
  }
  void destroy(PipelineId id) override {
    draw_put_off();
    if (const auto* p = ledger_.find(id)) programs_.release(p->native);
    ledger_.remove(id);
  }
  void destroy(TargetId id) override {
    draw_put_off();
    const bool in_use = open_ && id == pass_.target;  // the ledger rejects that
    if (ledger_.find(id) && !in_use) release_gl_target(gl_, ledger_, id);
    ledger_.remove(id);
  }

  void begin_frame() override { ledger_.begin_frame(); }
  void begin_pass(const PassDesc& pass) override;
  void draw(const DrawCall& call) override;
  void end_pass() override {
    if (!ledger_.end_pass()) return;
    if (begun_ || !ledger_.kept()) {
      draw_put_off(true);
      gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
    }
    put_off_.clear();
    open_ = false;
  }
  void resolve(TargetId from, TargetId to) override {
    if (!ledger_.resolve(from, to) || ledger_.kept()) return;
    const TargetDesc& d = ledger_.find(from)->desc;
    const ScissorRect whole{0, 0, d.width, d.height};
    copy_colour(from, ledger_.find(to)->native, std::span(&whole, 1));
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  }
  void read_pixels(TargetId target, std::span<uint8_t> rgba) override;
  void present(TargetId target) override {
    if (ledger_.present(target)) blit(target, 0, GL_COLOR_BUFFER_BIT);
  }
  DrawStats stats() const override { return ledger_.stats(); }
  void forget_contents() override { ledger_.forget_contents(); }
  std::vector<std::string> take_faults() override;
  Status take_link_failure() override {
    if (!link_failure_) ledger_.forget_contents();
    return std::exchange(link_failure_, {});
  }

 private:
  void begin_put_off();
  void draw_now(const DrawCall& call);
  /// Executes the deferred draws of the open pass, since their inputs are about to change or the
  /// pass ends.
  void draw_put_off(bool also_none = false) {
    if (!open_ || (put_off_.empty() && !also_none)) return;
    if (!begun_) begin_put_off();
    begun_ = true;
    for (const DrawCall& call : put_off_) draw_now(call);
    put_off_.clear();
  }
  void upload(const DeviceLedger::Buffer& buffer, size_t size, const void* data) {
    const GLenum where = target_of(buffer.use);
    gl_.BindBuffer(where, buffer.native);
    gl_.BufferData(where, GLsizeiptr(size), data, GL_STREAM_DRAW);
  }
  void blit(TargetId from, GLuint to, GLbitfield what) {
    const TargetDesc& d = ledger_.find(from)->desc;
    blit(from, to, what, {0, 0, d.width, d.height});
  }
  void blit(TargetId from, GLuint to, GLbitfield what, const ScissorRect& area) {
    const DeviceLedger::Target& t = *ledger_.find(from);
    const GLint x0 = area.x, x1 = x0 + area.width, y1 = t.desc.height - area.y,
                y0 = y1 - area.height;
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, t.native);
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
    gl_.BlitFramebuffer(x0, y0, x1, y1, x0, y0, x1, y1, what, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  }
  /// Copies the colour of these parts (pixels from the top left), samples averaged.
  void copy_colour(TargetId from, GLuint to, std::span<const ScissorRect> parts) {
    const DeviceLedger::Target& t = *ledger_.find(from);
    if (!t.colour_samples) {
      for (const ScissorRect& part : parts) blit(from, to, GL_COLOR_BUFFER_BIT, part);
      return;
    }
    std::vector<ScissorRect> upright(parts.begin(), parts.end());
    for (ScissorRect& p : upright) p.y = t.desc.height - p.y - p.height;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, to);
    gl_.Viewport(0, 0, t.desc.width, t.desc.height);
    if (Status done = average_.draw(t.colour_samples, t.samples, upright); !done && link_failure_)
      link_failure_ = std::move(done);
  }
  void set_scissor(const std::optional<ScissorRect>& scissor) {
    if (!scissor) return gl_.Disable(GL_SCISSOR_TEST);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.Scissor(scissor->x, pass_height_ - scissor->y - scissor->height, scissor->width,
                scissor->height);
  }

  GlFunctions gl_;
  GlPrograms programs_;
  GlAverage average_;
  DeviceLedger ledger_;
  DeviceInfo info_;
  GLuint vertex_array_ = 0;
  PassDesc pass_;  ///< the open one
  bool open_ = false, begun_ = false;
  std::vector<DrawCall> put_off_;  ///< calls of the open pass
  Status link_failure_;            ///< the first since take_link_failure() was called
  int pass_height_ = 0;
  std::vector<uint8_t> spare_row_;  ///< of a picture that is read back
};

TextureId GlDevice::create_texture(TextureFormat format, int width, int height,
                                   std::span<const std::byte> data) {
  const TextureId id = ledger_.add_texture(format, width, height, data);
  auto* t = ledger_.find(id);
  if (!t) return id;
  const bool narrow = format == TextureFormat::r8 || format == TextureFormat::r8_linear_filter;
  const bool smooth =
      format == TextureFormat::rgba8_linear_filter || format == TextureFormat::r8_linear_filter;
  gl_.GenTextures(1, &t->native);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, t->native);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, narrow ? GL_R8 : GL_RGBA8, width, height, 0,
                 narrow ? GL_RED : GL_RGBA, GL_UNSIGNED_BYTE, data.data());
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, smooth ? GL_LINEAR : GL_NEAREST);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, smooth ? GL_LINEAR : GL_NEAREST);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return id;
}

Result<PipelineId> GlDevice::create_pipeline(const PipelineDesc& desc) {
  const PipelineId id = ledger_.add_pipeline(desc);
  if (!id) return Error{ErrorCode::invalid_argument, "malformed pipeline", desc.name, ""};
  ledger_.find(id)->native = programs_.add(desc);
  return id;
}

Result<TargetId> GlDevice::create_target(const TargetDesc& desc) {
  if (std::max(desc.width, desc.height) > info_.max_texture_size)
    return Error{ErrorCode::unsupported,
                 fmt::format("{} x {} pixels are more than {} allows", desc.width, desc.height,
                             info_.renderer),
                 "", fmt::format("at most {} each way", info_.max_texture_size)};
  const TargetId id = ledger_.add_target(desc);
  if (!id) return Error{ErrorCode::invalid_argument, "bad target size", "", "1 to 16384 pixels"};
  draw_put_off();
  gl_.ActiveTexture(GL_TEXTURE0);
  Status made = make_gl_target(gl_, ledger_, id, info_.max_samples, info_.software);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, open_ && begun_ ? ledger_.find(pass_.target)->native : 0);
  if (made) return id;
  destroy(id);
  return made.error();
}

void GlDevice::begin_pass(const PassDesc& pass) {
  if (!ledger_.begin_pass(pass)) return;
  pass_ = pass;
  open_ = true;
  begun_ = false;
}

void GlDevice::begin_put_off() {
  const PassDesc& pass = pass_;
  const DeviceLedger::Target& t = *ledger_.find(pass.target);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, t.native);
  gl_.Viewport(0, 0, t.desc.width, t.desc.height);
  gl_.Disable(GL_SCISSOR_TEST);
  pass_height_ = t.desc.height;
  GLbitfield clear = 0;
  if (pass.clear_colour) {
    const auto& c = *pass.clear_colour;
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.ClearColor(c[0], c[1], c[2], c[3]);
    clear |= GL_COLOR_BUFFER_BIT;
  }
  if (pass.clear_depth && t.desc.depth != DepthAttachment::none) {
    gl_.DepthMask(GL_TRUE);
    clear |= GL_DEPTH_BUFFER_BIT;
  }
  if (clear) gl_.Clear(clear);
  if (pass.averages) copy_colour(pass.averages, t.native, pass.averaged_parts);
  for (const ScissorRect& part : pass.depth_parts)
    blit(pass.depth_of, t.native, GL_DEPTH_BUFFER_BIT, part);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, t.native);
}

void GlDevice::draw(const DrawCall& call) {
  if (ledger_.draw(call)) put_off_.push_back(call);
}

void GlDevice::draw_now(const DrawCall& call) {
  const DeviceLedger::Pipeline& pipeline = *ledger_.find(call.pipeline);
  const PipelineDesc& d = pipeline.desc;
  if (Status linked = programs_.link(pipeline.native); !linked) {
    if (link_failure_) link_failure_ = std::move(linked);
    return;
  }
  apply_gl_pipeline(gl_, d, pipeline.native);
  set_scissor(call.scissor);
  if (d.stride[0]) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, ledger_.find(call.vertices)->native);
    apply_gl_attributes(gl_, d, 0, 0);
  }
  if (d.stride[1]) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, ledger_.find(call.instances)->native);
    apply_gl_attributes(gl_, d, 1, call.instance_offset);
  }
  for (size_t i = 0; i < d.textures.size(); ++i) {
    gl_.ActiveTexture(GLenum(GL_TEXTURE0 + i));
    gl_.BindTexture(GL_TEXTURE_2D, ledger_.find(call.textures[i])->native);
  }
  for (size_t i = 0; i < d.uniform_blocks.size(); ++i) {
    const UniformRange& u = call.uniforms[i];
    gl_.BindBufferRange(GL_UNIFORM_BUFFER, GLuint(i), ledger_.find(u.buffer)->native, u.offset,
                        u.size);
  }
  const GLenum mode = d.topology == Topology::triangles ? GL_TRIANGLES : GL_TRIANGLE_STRIP;
  if (call.indices) {
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, ledger_.find(call.indices)->native);
    gl_.DrawElementsInstancedBaseVertex(
        mode, GLsizei(call.count), GL_UNSIGNED_INT,
        reinterpret_cast<const void*>(size_t(call.first) * sizeof(uint32_t)),
        GLsizei(call.instance_count), call.base_vertex);
  } else {
    gl_.DrawArraysInstanced(mode, GLint(call.first), GLsizei(call.count),
                            GLsizei(call.instance_count));
  }
  disable_gl_attributes(gl_, d);
}

void GlDevice::read_pixels(TargetId target, std::span<uint8_t> rgba) {
  if (!ledger_.read_pixels(target, rgba.size())) return;
  const DeviceLedger::Target& t = *ledger_.find(target);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, t.native);
  gl_.ReadPixels(0, 0, t.desc.width, t.desc.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  const size_t row = size_t(t.desc.width) * 4;
  spare_row_.resize(row);
  for (size_t y = 0, n = size_t(t.desc.height); y < n / 2; ++y) {  // std::swap_ranges goes by bytes
    uint8_t *const above = rgba.data() + y * row, *const below = rgba.data() + (n - 1 - y) * row;
    std::memcpy(spare_row_.data(), above, row);
    std::memcpy(above, below, row);
    std::memcpy(below, spare_row_.data(), row);
  }
}

std::vector<std::string> GlDevice::take_faults() {
  for (int i = 0; i < 8; ++i) {
    const GLenum error = gl_.GetError();
    if (error == GL_NO_ERROR) break;
    ledger_.fault(fmt::format("OpenGL error 0x{:04X}", error));
  }
  std::vector<std::string> faults = ledger_.take_faults();
  if (!faults.empty()) ledger_.forget_contents();
  return faults;
}

}  // namespace

Result<std::unique_ptr<Device>> make_gl_device(GlContext& context) {
  auto functions = GlFunctions::load(context);
  if (!functions) return functions.error();
  return std::unique_ptr<Device>(std::make_unique<GlDevice>(*functions, context.info()));
}

}  // namespace tumble
