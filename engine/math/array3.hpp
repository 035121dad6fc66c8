#pragma once
#include "engine/math/vector.hpp"

namespace tumble {

/// Results of a comparison, by coefficient.
struct Mask3 {
  bool x, y, z;
  constexpr bool all() const { return x && y && z; }
  constexpr bool any() const { return x || y || z; }
  constexpr int count() const { return int(x) + int(y) + int(z); }
  friend constexpr Mask3 operator&&(const Mask3& a, const Mask3& b) {
    return {a.x && b.x, a.y && b.y, a.z && b.z};
  }
  friend constexpr Mask3 operator||(const Mask3& a, const Mask3& b) {
    return {a.x || b.x, a.y || b.y, a.z || b.z};
  }
};

/// Three numbers with coefficient-wise operations, also with scalars; returned by Vector3::array(),
/// and converts back to a vector implicitly.
template <class T>
class Array3 {
 public:
  constexpr Array3(const Vector3<T>& v) : v_(v) {}
  constexpr Array3(T s) : v_(Vector3<T>::Constant(s)) {}
  constexpr operator Vector3<T>() const { return v_; }
  constexpr const Vector3<T>& matrix() const { return v_; }
  constexpr const T& operator[](std::ptrdiff_t i) const { return v_[i]; }

  Array3 abs() const { return v_.cwiseAbs(); }
  Array3 sqrt() const { return v_.cwiseSqrt(); }
  Array3 floor() const {
    return Vector3<T>{std::floor(v_[0]), std::floor(v_[1]), std::floor(v_[2])};
  }
  Array3 ceil() const { return Vector3<T>{std::ceil(v_[0]), std::ceil(v_[1]), std::ceil(v_[2])}; }
  Array3 round() const {
    return Vector3<T>{std::round(v_[0]), std::round(v_[1]), std::round(v_[2])};
  }
  constexpr Array3 square() const { return v_.cwiseAbs2(); }
  constexpr Array3 inverse() const { return v_.cwiseInverse(); }
  constexpr Array3 min(const Array3& b) const { return v_.cwiseMin(b.v_); }
  constexpr Array3 max(const Array3& b) const { return v_.cwiseMax(b.v_); }
  constexpr T sum() const { return v_.sum(); }
  constexpr T prod() const { return v_.prod(); }
  constexpr T minCoeff() const { return v_.minCoeff(); }
  constexpr T maxCoeff() const { return v_.maxCoeff(); }
  template <class U>
  constexpr Array3<U> cast() const {
    return v_.template cast<U>();
  }

  friend constexpr Array3 operator+(const Array3& a, const Array3& b) { return a.v_ + b.v_; }
  friend constexpr Array3 operator-(const Array3& a, const Array3& b) { return a.v_ - b.v_; }
  friend constexpr Array3 operator-(const Array3& a) { return -a.v_; }
  friend constexpr Array3 operator*(const Array3& a, const Array3& b) {
    return a.v_.cwiseProduct(b.v_);
  }
  friend constexpr Array3 operator/(const Array3& a, const Array3& b) {
    return a.v_.cwiseQuotient(b.v_);
  }
  friend constexpr Mask3 operator<(const Array3& a, const Array3& b) {
    return {a[0] < b[0], a[1] < b[1], a[2] < b[2]};
  }
  friend constexpr Mask3 operator<=(const Array3& a, const Array3& b) {
    return {a[0] <= b[0], a[1] <= b[1], a[2] <= b[2]};
  }
  friend constexpr Mask3 operator>(const Array3& a, const Array3& b) { return b < a; }
  friend constexpr Mask3 operator>=(const Array3& a, const Array3& b) { return b <= a; }
  friend constexpr Mask3 operator==(const Array3& a, const Array3& b) {
    return {a[0] == b[0], a[1] == b[1], a[2] == b[2]};
  }
  friend constexpr Mask3 operator!=(const Array3& a, const Array3& b) {
    return {a[0] != b[0], a[1] != b[1], a[2] != b[2]};
  }

 private:
  Vector3<T> v_;
};

}  // namespace tumble
