#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/frame_setup.hpp"

namespace tumble {

/// The render targets for one picture size and quality, made anew when either changes.
class PictureTargets {
 public:
  explicit PictureTargets(Device& device) : device_(device) {}
  ~PictureTargets() { release(); }
  PictureTargets(const PictureTargets&) = delete;
  PictureTargets& operator=(const PictureTargets&) = delete;

  /// The world is drawn with `resolution` (at most 1) times as many pixels along each axis.
  /// `covered`: words or panels are drawn over it.
  Status prepare(int width, int height, float resolution, const QualityValues& quality,
                 bool covered);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Width of the canvas [px].
  int drawn_width() const { return drawn_width_; }
  int drawn_height() const { return drawn_height_; }
  /// The target that the world is drawn into: multisampled, or with fewer pixels than the picture,
  /// or both.
  TargetId canvas() const { return canvas_ ? canvas_ : picture_; }
  /// Single-sampled target with as many pixels as the canvas; the canvas itself if that is
  /// single-sampled.
  TargetId averaged() const { return world_ ? world_ : canvas(); }
  bool is_reduced() const { return drawn_width_ != width_ || drawn_height_ != height_; }
  /// Single-sampled, readable. A world that nothing covers is the picture itself; one that panels
  /// cover stays apart, so that it is not drawn again when only these change.
  TargetId picture() const { return picture_ ? picture_ : world_; }
  TargetId shadow() const { return shadow_; }
  TargetId contact(int i) const { return contact_[size_t(i)]; }
  TextureId shadow_map() const { return device_.depth_texture(shadow_); }
  TextureId contact_map() const { return contact_texture(0); }
  TextureId contact_texture(int i) const { return device_.colour_texture(contact(i)); }

 private:
  Status make(TargetId& target, const TargetDesc& desc);
  Status separate_picture();
  void release();

  Device& device_;
  int width_ = 0, height_ = 0, drawn_width_ = 0, drawn_height_ = 0;
  QualityValues quality_{};
  TargetId canvas_, world_, picture_, shadow_;
  std::array<TargetId, 2> contact_;
};

}  // namespace tumble
