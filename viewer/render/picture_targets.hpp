#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/frame_setup.hpp"

namespace tumble {

/// The targets of one picture size and quality, remade when either changes.
class PictureTargets {
 public:
  explicit PictureTargets(Device& device) : device_(device) {}
  ~PictureTargets() { release(); }
  PictureTargets(const PictureTargets&) = delete;
  PictureTargets& operator=(const PictureTargets&) = delete;

  /// The world is drawn with `resolution` times as many pixels each way, up to 1.
  Status prepare(int width, int height, float resolution, const QualityValues& quality);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Of the canvas.
  int drawn_width() const { return drawn_width_; }
  int drawn_height() const { return drawn_height_; }
  /// Drawn into: many samples, or fewer pixels than the picture has, or both.
  TargetId canvas() const { return canvas_ ? canvas_ : picture_; }
  /// As many pixels as the canvas, one sample: the canvas itself unless that has many.
  TargetId averaged() const { return world_ ? world_ : canvas(); }
  bool is_reduced() const { return drawn_width_ != width_ || drawn_height_ != height_; }
  TargetId picture() const { return picture_; }  ///< one sample, readable
  TargetId shadow() const { return shadow_; }
  TargetId contact(int i) const { return contact_[size_t(i)]; }
  TextureId shadow_map() const { return device_.depth_texture(shadow_); }
  TextureId contact_map() const { return contact_texture(0); }
  TextureId contact_texture(int i) const { return device_.colour_texture(contact(i)); }

 private:
  Status make(TargetId& target, const TargetDesc& desc);
  void release();

  Device& device_;
  int width_ = 0, height_ = 0, drawn_width_ = 0, drawn_height_ = 0;
  QualityValues quality_{};
  TargetId canvas_, world_, picture_, shadow_;
  std::array<TargetId, 2> contact_;
};

}  // namespace tumble
