#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace tumble {

/// Up to four points with what they share, of which `Head::count` says how many there are. Most of
/// the memory that a tick moves is contacts, and many have one point only: beyond the count none is
/// initialised or copied.
template <class Head, class Point>
struct FewPoints : Head {
  union {
    std::array<Point, 4> points;
  };

  FewPoints() {}
  FewPoints(const FewPoints& from) : Head(from) { take_points(from); }
  FewPoints& operator=(const FewPoints& from) {
    Head::operator=(from);
    take_points(from);
    return *this;
  }
  std::span<Point> used() { return {points.data(), size_t(this->count)}; }
  std::span<const Point> used() const { return {points.data(), size_t(this->count)}; }

 private:
  void take_points(const FewPoints& from) {
    std::uninitialized_copy_n(from.points.begin(), size_t(from.count), points.begin());
  }
};

}  // namespace tumble
