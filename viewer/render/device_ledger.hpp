#pragma once
#include "viewer/render/device.hpp"

namespace tumble {

/// Records by id. Ids carry a generation, so that a stale id finds nothing.
template <class Id, class Record>
class Slots {
 public:
  Id add(Record record) {
    uint32_t index = 0;
    while (index < slots_.size() && slots_[index].used) ++index;
    if (index == slots_.size()) slots_.emplace_back();
    Slot& slot = slots_[index];
    slot.used = true;
    slot.record = std::move(record);
    return Id{(slot.generation << 16) | (index + 1)};
  }
  Record* find(Id id) {
    const uint32_t index = (id.value & 0xFFFFu) - 1;
    if (!id || index >= slots_.size()) return nullptr;
    Slot& slot = slots_[index];
    return slot.used && slot.generation == id.value >> 16 ? &slot.record : nullptr;
  }
  bool remove(Id id) {
    if (!find(id)) return false;
    Slot& slot = slots_[(id.value & 0xFFFFu) - 1];
    slot.used = false;
    slot.generation = (slot.generation + 1) & 0xFFFFu;
    slot.record = {};
    return true;
  }
  template <class Act>
  void for_each(Act&& act) {
    for (Slot& s : slots_)
      if (s.used) act(s.record);
  }
  uint32_t live() const {
    uint32_t n = 0;
    for (const Slot& s : slots_) n += s.used;
    return n;
  }

 private:
  struct Slot {
    bool used = false;
    uint32_t generation = 0;
    Record record{};
  };
  std::vector<Slot> slots_;
};

/// What all devices have in common: hands out ids, checks each call, counts, and hashes the draw
/// list. A device asks the ledger first and calls its graphics library only if the ledger accepts
/// the call.
class DeviceLedger {
 public:
  struct Buffer {
    BufferUse use = BufferUse::vertex;
    size_t size = 0;
    uint64_t content = 0;
    bool defined = false;
    std::vector<uint32_t> indices;  ///< contents of index buffers, if strict
    unsigned native = 0;            ///< name (handle) in the graphics library
  };
  struct Texture {
    int width = 0, height = 0;
    uint64_t content = 0;
    TargetId owner;
    bool compares = false;
    unsigned native = 0;
  };
  struct Pipeline {
    PipelineDesc desc;  ///< without the sources
    uint64_t content = 0;
    unsigned native = 0;
  };
  struct Target {
    TargetDesc desc;
    TextureId colour, depth;
    uint64_t held = 0;  ///< hash of all that decided its present contents; 0: unknown
    unsigned native = 0;
    unsigned colour_storage = 0, depth_storage = 0;  ///< renderbuffers
    unsigned colour_samples = 0;  ///< texture with all samples, instead of colour_storage
    int samples = 1;              ///< as many as the driver gave
  };

  /// `strict` also checks every index of a draw against the vertex buffer.
  explicit DeviceLedger(bool strict) : strict_(strict) {}

  BufferId add_buffer(BufferUse use, size_t size, std::span<const std::byte> data);
  bool update_buffer(BufferId id, std::span<const std::byte> data);
  TextureId add_texture(TextureFormat format, int width, int height,
                        std::span<const std::byte> data);
  PipelineId add_pipeline(const PipelineDesc& desc);
  TargetId add_target(const TargetDesc& desc);

  template <class Id>
  auto* find(Id id) {
    return slots(id).find(id);
  }
  bool remove(BufferId id) { return remove_from(buffers_, id, "buffer"); }
  bool remove(TextureId id);
  bool remove(PipelineId id) { return remove_from(pipelines_, id, "pipeline"); }
  bool remove(TargetId id);

  void begin_frame();
  bool begin_pass(const PassDesc& pass);
  bool draw(const DrawCall& call);
  bool end_pass();
  bool resolve(TargetId from, TargetId to);
  /// Whether the target already had the result of the last pass or resolve.
  bool kept() const { return kept_; }
  /// Marks the contents of all targets as unknown.
  void forget_contents();
  bool read_pixels(TargetId target, size_t bytes);
  bool present(TargetId target);

  DrawStats stats() const;
  void fault(std::string sentence);
  std::vector<std::string> take_faults() { return std::exchange(faults_, {}); }

 private:
  Slots<BufferId, Buffer>& slots(BufferId) { return buffers_; }
  Slots<TextureId, Texture>& slots(TextureId) { return textures_; }
  Slots<PipelineId, Pipeline>& slots(PipelineId) { return pipelines_; }
  Slots<TargetId, Target>& slots(TargetId) { return targets_; }

  template <class Id, class Record>
  bool remove_from(Slots<Id, Record>& slots, Id id, const char* what) {
    if (slots.remove(id)) return true;
    fault(std::string("destroy of a ") + what + " that does not exist");
    return false;
  }
  bool check_inputs(const DrawCall& call, const Pipeline& pipeline);
  bool check_indices(const DrawCall& call, const Pipeline& pipeline);
  bool check_bindings(const DrawCall& call, const Pipeline& pipeline);
  bool check_target(const DrawCall& call, const Pipeline& pipeline);
  void mix(const void* data, size_t size);
  template <class T>
  void mix(const T& value) {
    mix(&value, sizeof value);
  }
  uint64_t hash_of(const DrawCall& call, const Pipeline& pipeline, uint64_t seed);
  void hash_draw(const DrawCall& call, const Pipeline& pipeline);
  bool check_average(const PassDesc& pass, const Target* from, const Target* to);
  bool check_depth(const PassDesc& pass, const Target* from, const Target* to);
  /// The open pass begins with parts of the contents of another target.
  void take_from(const Target& from, std::span<const ScissorRect> parts);
  bool check_resolve(const Target* from, const Target* to);
  void note_content(uint64_t& held, uint64_t content);

  bool strict_;
  Slots<BufferId, Buffer> buffers_;
  Slots<TextureId, Texture> textures_;
  Slots<PipelineId, Pipeline> pipelines_;
  Slots<TargetId, Target> targets_;
  TargetId current_;             ///< target of the open pass
  uint64_t pass_content_ = 0;    ///< hash of the open pass so far, as Target::held
  bool depth_is_fresh_ = false;  ///< no draw of the pass has changed the cleared depth yet
  bool kept_ = false;
  DrawStats stats_;
  std::vector<std::string> faults_;
};

}  // namespace tumble
