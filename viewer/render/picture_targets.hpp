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

  Status prepare(int width, int height, const QualityValues& quality);

  int width() const { return width_; }
  int height() const { return height_; }
  TargetId canvas() const { return canvas_ ? canvas_ : picture_; }  ///< drawn into, many samples
  TargetId picture() const { return picture_; }                     ///< one sample, readable
  TargetId shadow() const { return shadow_; }
  TargetId contact(int i) const { return contact_[size_t(i)]; }
  TextureId shadow_map() const { return device_.depth_texture(shadow_); }
  TextureId contact_map() const { return contact_texture(0); }
  TextureId contact_texture(int i) const { return device_.colour_texture(contact(i)); }

 private:
  Status make(TargetId& target, const TargetDesc& desc);
  void release();

  Device& device_;
  int width_ = 0, height_ = 0;
  QualityValues quality_{};
  TargetId canvas_, picture_, shadow_;
  std::array<TargetId, 2> contact_;
};

}  // namespace tumble
