#include "viewer/render/null/null_device.hpp"

#include "viewer/render/device_ledger.hpp"

namespace tumble {
namespace {

class NullDevice final : public Device {
 public:
  NullDevice() : ledger_(true), info_{"null", "null", "1.0", true, 16384, 4} {}

  const DeviceInfo& info() const override { return info_; }
  BufferId create_buffer(BufferUse use, size_t size, std::span<const std::byte> data) override {
    return ledger_.add_buffer(use, size, data);
  }
  void update_buffer(BufferId buffer, std::span<const std::byte> data) override {
    ledger_.update_buffer(buffer, data);
  }
  TextureId create_texture(TextureFormat format, int width, int height,
                           std::span<const std::byte> data) override {
    return ledger_.add_texture(format, width, height, data);
  }
  Result<PipelineId> create_pipeline(const PipelineDesc& desc) override {
    const PipelineId id = ledger_.add_pipeline(desc);
    if (!id) return Error{ErrorCode::invalid_argument, "malformed pipeline", desc.name, ""};
    return id;
  }
  Result<TargetId> create_target(const TargetDesc& desc) override {
    const TargetId id = ledger_.add_target(desc);
    if (!id) return Error{ErrorCode::invalid_argument, "bad target size", "", "1 to 16384 pixels"};
    return id;
  }
  TextureId colour_texture(TargetId target) override {
    const auto* t = ledger_.find(target);
    return t ? t->colour : TextureId{};
  }
  TextureId depth_texture(TargetId target) override {
    const auto* t = ledger_.find(target);
    return t ? t->depth : TextureId{};
  }
  void destroy(BufferId id) override { ledger_.remove(id); }
  void destroy(TextureId id) override { ledger_.remove(id); }
  void destroy(PipelineId id) override { ledger_.remove(id); }
  void destroy(TargetId id) override { ledger_.remove(id); }

  void begin_frame() override { ledger_.begin_frame(); }
  void begin_pass(const PassDesc& pass) override { ledger_.begin_pass(pass); }
  void draw(const DrawCall& call) override { ledger_.draw(call); }
  void end_pass() override { ledger_.end_pass(); }
  void resolve(TargetId from, TargetId to) override { ledger_.resolve(from, to); }
  void read_pixels(TargetId target, std::span<uint8_t> rgba) override {
    if (!ledger_.read_pixels(target, rgba.size())) return;
    const uint64_t hash = ledger_.stats().hash;
    for (size_t i = 0; i < rgba.size(); ++i)
      rgba[i] = uint8_t(i % 4 == 3 ? 255 : hash >> (8 * ((i / 4) % 7)));
  }
  void present(TargetId target) override { ledger_.present(target); }
  DrawStats stats() const override { return ledger_.stats(); }
  void forget_contents() override { ledger_.forget_contents(); }
  std::vector<std::string> take_faults() override { return ledger_.take_faults(); }
  Status take_link_failure() override { return {}; }

 private:
  DeviceLedger ledger_;
  DeviceInfo info_;
};

}  // namespace

std::unique_ptr<Device> make_null_device() {
  return std::make_unique<NullDevice>();
}

}  // namespace tumble
