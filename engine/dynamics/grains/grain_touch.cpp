#include "engine/dynamics/grains/grain_touch.hpp"

#include <algorithm>

namespace tumble {

void GrainTouches::replace(std::vector<GrainTouch>& next, uint64_t grains) {
  if (replaced_) {
    now_.swap(next);
  } else {
    before_.swap(now_);
    now_.swap(next);
    grains_before_ = grains_;
  }
  grains_ = grains;
  replaced_ = true;
}

void GrainTouches::go_back() {
  loads_.swap(loads_before_);
  if (!replaced_) return;
  now_.swap(before_);
  grains_ = grains_before_;
  replaced_ = false;
}

void GrainTouches::clear() {
  now_.clear();
  loads_.clear();
  grains_ = 0;
}

void GrainTouches::save(ByteWriter& out) const {
  out.value(grains_);
  out.value(uint64_t(now_.size()));
  out.raw(now_.data(), now_.size() * sizeof(GrainTouch));
  out.value(uint64_t(loads_.size()));
  out.raw(loads_.data(), loads_.size() * sizeof(GrainLoad));
}

void GrainTouches::load(ByteReader& in) {
  in.value(grains_);
  const auto count = in.get<uint64_t>();
  if (count > in.remaining() / sizeof(GrainTouch)) return in.fail();
  now_.resize(size_t(count));
  in.raw(now_.data(), now_.size() * sizeof(GrainTouch));
  const auto loads = in.get<uint64_t>();
  if (loads > in.remaining() / sizeof(GrainLoad)) return in.fail();
  loads_.resize(size_t(loads));
  in.raw(loads_.data(), loads_.size() * sizeof(GrainLoad));
  if (!in_order()) in.fail();
}

bool GrainTouches::in_order() const {
  std::vector<uint64_t> grains;
  for (size_t k = 0; k < now_.size(); ++k) {
    if (k == 0 || now_[k - 1].a != now_[k].a)
      grains.push_back(now_[k].a);
    else if (now_[k - 1].b >= now_[k].b)
      return false;
  }
  std::ranges::sort(grains);
  return std::ranges::adjacent_find(grains) == grains.end();
}

void wake_grains_on(const GrainTouches& touches, uint32_t body, std::span<ParticleSystem> systems) {
  for (const GrainTouch& t : touches.all()) {
    if (!t.on_body() || t.body() != body) continue;
    const auto system = size_t(t.a >> 48);
    if (system >= systems.size() || !systems[system].grains) continue;
    ParticleSystem& p = systems[system];
    const size_t i = p.find(t.a & 0xffffffffffff);
    if (i < p.size() && p.rest[i].asleep()) p.rest[i] = {};
  }
}

}  // namespace tumble
