#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace tumble {

/// Up to four points with their common data; `Head::count` is their number. Most of the memory
/// traffic of a tick is contacts, many of which have one point only, so points beyond the count are
/// neither initialised nor copied.
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
