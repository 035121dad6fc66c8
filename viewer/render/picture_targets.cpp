#include "viewer/render/picture_targets.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {

Status PictureTargets::make(TargetId& target, const TargetDesc& desc) {
  auto made = device_.create_target(desc);
  if (!made) return made.error();
  target = *made;
  return {};
}

Status PictureTargets::prepare(int width, int height, float resolution,
                               const QualityValues& quality, bool covered) {
  const auto reduced = [&](int pixels) {
    return std::clamp(int(std::lround(float(pixels) * resolution)), std::min(pixels, 1), pixels);
  };
  const int drawn_width = reduced(width), drawn_height = reduced(height);
  if (width == width_ && height == height_ && drawn_width == drawn_width_ &&
      drawn_height == drawn_height_ && quality == quality_)
    return covered ? separate_picture() : Status();
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    return Error{ErrorCode::invalid_argument,
                 fmt::format("picture size {} x {} is not in 1..16384", width, height), "", ""};
  release();
  TargetDesc d;
  d.width = width;
  d.height = height;
  const bool many = quality.samples > 1, fewer = drawn_width < width || drawn_height < height;
  d.depth = many || fewer ? DepthAttachment::none : DepthAttachment::buffer;
  Status s;
  if (covered || fewer || !many) s = make(picture_, d);
  d.width = drawn_width;
  d.height = drawn_height;
  if (s && many) s = make(world_, d);
  if (s && (many || fewer)) {
    d.samples = quality.samples;
    d.depth = DepthAttachment::buffer;
    s = make(canvas_, d);
  }
  d = {};
  d.width = d.height = quality.shadow_size;
  d.colour = ColourAttachment::none;
  d.depth = DepthAttachment::shadow_texture;
  if (s) s = make(shadow_, d);
  d.width = d.height = quality.contact_size;
  d.colour = ColourAttachment::r8;
  d.depth = DepthAttachment::buffer;
  for (TargetId& t : contact_)
    if (s) s = make(t, d);
  if (!s) {
    release();
    return s;
  }
  width_ = width;
  height_ = height;
  drawn_width_ = drawn_width;
  drawn_height_ = drawn_height;
  quality_ = quality;
  return {};
}

Status PictureTargets::separate_picture() {
  if (picture_) return {};
  TargetDesc d;
  d.width = width_;
  d.height = height_;
  d.depth = DepthAttachment::none;
  return make(picture_, d);
}

void PictureTargets::release() {
  for (TargetId* t : {&canvas_, &world_, &picture_, &shadow_, &contact_[0], &contact_[1]}) {
    if (*t) device_.destroy(*t);
    *t = {};
  }
  width_ = height_ = drawn_width_ = drawn_height_ = 0;
}

}  // namespace tumble
