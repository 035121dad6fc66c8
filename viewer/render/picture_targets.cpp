#include "viewer/render/picture_targets.hpp"

#include <fmt/format.h>

namespace tumble {

Status PictureTargets::make(TargetId& target, const TargetDesc& desc) {
  auto made = device_.create_target(desc);
  if (!made) return made.error();
  target = *made;
  return {};
}

Status PictureTargets::prepare(int width, int height, const QualityValues& quality) {
  if (width == width_ && height == height_ && quality == quality_) return {};
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    return Error{ErrorCode::invalid_argument,
                 fmt::format("picture size {} x {} is not in 1..16384", width, height), "", ""};
  release();
  TargetDesc d;
  d.width = width;
  d.height = height;
  const bool many = quality.samples > 1;
  d.depth = many ? DepthAttachment::none : DepthAttachment::buffer;
  Status s = make(picture_, d);
  if (s && many) {
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
  quality_ = quality;
  return {};
}

void PictureTargets::release() {
  for (TargetId* t : {&canvas_, &picture_, &shadow_, &contact_[0], &contact_[1]}) {
    if (*t) device_.destroy(*t);
    *t = {};
  }
  width_ = height_ = 0;
}

}  // namespace tumble
