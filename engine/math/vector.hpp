#pragma once
#include <cmath>
#include <cstddef>

// Vectors of two, three and four numbers, column vectors all: plain values, so that `a + s * b` is
// a vector like any other, costs nothing to compile and may be kept by `auto`. A library of dense
// matrices makes a type of each expression and compiles its evaluation anew in each source; the
// house asks for one (Eigen) only where sizes are found at run time: math/dense.hpp.
//
// Only what has a name can be assigned to: parts such as v.head<2>() are copies, and to write into
// one is an error. Sums add their terms from the first to the last, in vectors and matrices alike.
// Names of functions are those of Eigen, which people in this field know; tests/math/vectors_test
// compares the two.
namespace tumble {

template <class T>
class Vector2;
template <class T>
class Vector3;
template <class T>
class Vector4;
template <class T>
class Row3;
template <class T>
class Diagonal3;
template <class T>
class Array3;

namespace detail {
/// The largest difference that still passes for rounding where no other is given, relative.
template <class T>
inline constexpr T rounding = sizeof(T) < sizeof(double) ? T(1e-5) : T(1e-12);
}  // namespace detail

template <class T>
class Vector2 {
 public:
  using Scalar = T;
  Vector2() = default;  ///< its numbers are not set
  constexpr Vector2(const Vector2&) = default;
  constexpr Vector2& operator=(const Vector2&) & = default;
  constexpr Vector2(T x, T y) : c_{x, y} {}
  static constexpr Vector2 Zero() { return {0, 0}; }
  static constexpr Vector2 Constant(T s) { return {s, s}; }

  constexpr T& operator[](std::ptrdiff_t i) { return c_[i]; }
  constexpr const T& operator[](std::ptrdiff_t i) const { return c_[i]; }
  constexpr T& operator()(std::ptrdiff_t i) { return c_[i]; }
  constexpr const T& operator()(std::ptrdiff_t i) const { return c_[i]; }
  constexpr T& x() { return c_[0]; }
  constexpr T& y() { return c_[1]; }
  constexpr const T& x() const { return c_[0]; }
  constexpr const T& y() const { return c_[1]; }
  constexpr T* data() { return c_; }
  constexpr const T* data() const { return c_; }
  static constexpr std::ptrdiff_t size() { return 2; }

  constexpr T dot(const Vector2& b) const { return c_[0] * b[0] + c_[1] * b[1]; }
  constexpr T squaredNorm() const { return dot(*this); }
  T norm() const { return std::sqrt(squaredNorm()); }
  Vector2 normalized() const {
    const T n = squaredNorm();
    return n > 0 ? *this / std::sqrt(n) : *this;
  }
  void normalize() & { *this = normalized(); }
  constexpr Vector2 cwiseMin(const Vector2& b) const {
    return {b[0] < c_[0] ? b[0] : c_[0], b[1] < c_[1] ? b[1] : c_[1]};
  }
  constexpr Vector2 cwiseMax(const Vector2& b) const {
    return {c_[0] < b[0] ? b[0] : c_[0], c_[1] < b[1] ? b[1] : c_[1]};
  }
  constexpr Vector2 cwiseProduct(const Vector2& b) const { return {c_[0] * b[0], c_[1] * b[1]}; }
  Vector2 cwiseAbs() const { return {std::abs(c_[0]), std::abs(c_[1])}; }
  constexpr T minCoeff() const { return c_[1] < c_[0] ? c_[1] : c_[0]; }
  constexpr T maxCoeff() const { return c_[0] < c_[1] ? c_[1] : c_[0]; }
  bool allFinite() const { return std::isfinite(c_[0]) && std::isfinite(c_[1]); }
  template <class U>
  constexpr Vector2<U> cast() const {
    return {U(c_[0]), U(c_[1])};
  }

  constexpr Vector2& operator+=(const Vector2& b) & { return *this = *this + b; }
  constexpr Vector2& operator-=(const Vector2& b) & { return *this = *this - b; }
  constexpr Vector2& operator*=(T s) & { return *this = *this * s; }
  constexpr Vector2& operator/=(T s) & { return *this = *this / s; }
  friend constexpr Vector2 operator+(const Vector2& a, const Vector2& b) {
    return {a[0] + b[0], a[1] + b[1]};
  }
  friend constexpr Vector2 operator-(const Vector2& a, const Vector2& b) {
    return {a[0] - b[0], a[1] - b[1]};
  }
  friend constexpr Vector2 operator-(const Vector2& a) { return {-a[0], -a[1]}; }
  friend constexpr Vector2 operator*(T s, const Vector2& a) { return {s * a[0], s * a[1]}; }
  friend constexpr Vector2 operator*(const Vector2& a, T s) { return {a[0] * s, a[1] * s}; }
  friend constexpr Vector2 operator/(const Vector2& a, T s) { return {a[0] / s, a[1] / s}; }
  friend constexpr bool operator==(const Vector2& a, const Vector2& b) {
    return a[0] == b[0] && a[1] == b[1];
  }

 private:
  T c_[2];
};

template <class T>
class Vector3 {
 public:
  using Scalar = T;
  Vector3() = default;  ///< its numbers are not set
  constexpr Vector3(const Vector3&) = default;
  constexpr Vector3& operator=(const Vector3&) & = default;
  constexpr Vector3(T x, T y, T z) : c_{x, y, z} {}
  /// The three numbers that stand at `from`.
  constexpr explicit Vector3(const T* from) : c_{from[0], from[1], from[2]} {}
  static constexpr Vector3 Zero() { return {0, 0, 0}; }
  static constexpr Vector3 Ones() { return {1, 1, 1}; }
  static constexpr Vector3 Constant(T s) { return {s, s, s}; }
  static constexpr Vector3 UnitX() { return {1, 0, 0}; }
  static constexpr Vector3 UnitY() { return {0, 1, 0}; }
  static constexpr Vector3 UnitZ() { return {0, 0, 1}; }
  static constexpr Vector3 Unit(std::ptrdiff_t i) { return {T(i == 0), T(i == 1), T(i == 2)}; }

  constexpr T& operator[](std::ptrdiff_t i) { return c_[i]; }
  constexpr const T& operator[](std::ptrdiff_t i) const { return c_[i]; }
  constexpr T& operator()(std::ptrdiff_t i) { return c_[i]; }
  constexpr const T& operator()(std::ptrdiff_t i) const { return c_[i]; }
  constexpr T& x() { return c_[0]; }
  constexpr T& y() { return c_[1]; }
  constexpr T& z() { return c_[2]; }
  constexpr const T& x() const { return c_[0]; }
  constexpr const T& y() const { return c_[1]; }
  constexpr const T& z() const { return c_[2]; }
  constexpr T* data() { return c_; }
  constexpr const T* data() const { return c_; }
  static constexpr std::ptrdiff_t size() { return 3; }
  /// The first and the last two.
  template <int N>
  requires(N == 2) constexpr Vector2<T> head() const { return {c_[0], c_[1]}; }
  template <int N>
  requires(N == 2) constexpr Vector2<T> tail() const { return {c_[1], c_[2]}; }

  constexpr void setZero() & { *this = Zero(); }
  constexpr void setConstant(T s) & { *this = Constant(s); }

  constexpr T dot(const Vector3& b) const { return c_[0] * b[0] + c_[1] * b[1] + c_[2] * b[2]; }
  constexpr Vector3 cross(const Vector3& b) const {
    return {c_[1] * b[2] - c_[2] * b[1], c_[2] * b[0] - c_[0] * b[2], c_[0] * b[1] - c_[1] * b[0]};
  }
  constexpr T squaredNorm() const { return dot(*this); }
  T norm() const { return std::sqrt(squaredNorm()); }
  /// The length where its square would overflow or vanish.
  T stableNorm() const {
    const T largest = cwiseAbs().maxCoeff();
    if (!(largest > 0)) return largest;
    const T shrink = T(1) / largest;
    if (!std::isfinite(shrink) || !std::isfinite(largest))
      return largest * (*this / largest).norm();
    return largest * (*this * shrink).norm();
  }
  /// The vector at length 1; the zero vector stays as it is.
  Vector3 normalized() const {
    const T n = squaredNorm();
    return n > 0 ? *this / std::sqrt(n) : *this;
  }
  void normalize() & { *this = normalized(); }
  /// A unit vector across this one, which must not be zero.
  Vector3 unitOrthogonal() const {
    const T negligible = detail::rounding<T> * std::abs(c_[2]);
    if (std::abs(c_[0]) > negligible || std::abs(c_[1]) > negligible) {
      const T shrink = T(1) / std::sqrt(c_[0] * c_[0] + c_[1] * c_[1]);
      return {-c_[1] * shrink, c_[0] * shrink, 0};
    }
    const T shrink = T(1) / std::sqrt(c_[1] * c_[1] + c_[2] * c_[2]);
    return {0, -c_[2] * shrink, c_[1] * shrink};
  }

  constexpr Vector3 cwiseProduct(const Vector3& b) const {
    return {c_[0] * b[0], c_[1] * b[1], c_[2] * b[2]};
  }
  constexpr Vector3 cwiseQuotient(const Vector3& b) const {
    return {c_[0] / b[0], c_[1] / b[1], c_[2] / b[2]};
  }
  constexpr Vector3 cwiseInverse() const { return {1 / c_[0], 1 / c_[1], 1 / c_[2]}; }
  Vector3 cwiseAbs() const { return {std::abs(c_[0]), std::abs(c_[1]), std::abs(c_[2])}; }
  constexpr Vector3 cwiseAbs2() const { return cwiseProduct(*this); }
  Vector3 cwiseSqrt() const { return {std::sqrt(c_[0]), std::sqrt(c_[1]), std::sqrt(c_[2])}; }
  constexpr Vector3 cwiseMin(const Vector3& b) const {
    return {b[0] < c_[0] ? b[0] : c_[0], b[1] < c_[1] ? b[1] : c_[1], b[2] < c_[2] ? b[2] : c_[2]};
  }
  constexpr Vector3 cwiseMax(const Vector3& b) const {
    return {c_[0] < b[0] ? b[0] : c_[0], c_[1] < b[1] ? b[1] : c_[1], c_[2] < b[2] ? b[2] : c_[2]};
  }
  constexpr Vector3 cwiseMin(T s) const { return cwiseMin(Constant(s)); }
  constexpr Vector3 cwiseMax(T s) const { return cwiseMax(Constant(s)); }
  constexpr T sum() const { return c_[0] + c_[1] + c_[2]; }
  constexpr T prod() const { return c_[0] * c_[1] * c_[2]; }
  constexpr T mean() const { return sum() / 3; }
  constexpr T minCoeff() const {
    const T low = c_[2] < c_[1] ? c_[2] : c_[1];
    return low < c_[0] ? low : c_[0];
  }
  constexpr T maxCoeff() const {
    const T high = c_[1] < c_[2] ? c_[2] : c_[1];
    return c_[0] < high ? high : c_[0];
  }
  /// The same, and which it is: the first of equals.
  template <class Index>
  constexpr T minCoeff(Index* at) const {
    *at = Index(c_[1] < c_[0] ? (c_[2] < c_[1] ? 2 : 1) : (c_[2] < c_[0] ? 2 : 0));
    return c_[*at];
  }
  template <class Index>
  constexpr T maxCoeff(Index* at) const {
    *at = Index(c_[1] > c_[0] ? (c_[2] > c_[1] ? 2 : 1) : (c_[2] > c_[0] ? 2 : 0));
    return c_[*at];
  }

  bool allFinite() const {
    return std::isfinite(c_[0]) && std::isfinite(c_[1]) && std::isfinite(c_[2]);
  }
  bool hasNaN() const { return std::isnan(c_[0]) || std::isnan(c_[1]) || std::isnan(c_[2]); }
  /// Whether no number is larger than `most`.
  bool isZero(T most = detail::rounding<T>) const {
    return std::abs(c_[0]) <= most && std::abs(c_[1]) <= most && std::abs(c_[2]) <= most;
  }
  /// Whether the difference is small beside the shorter of the two.
  bool isApprox(const Vector3& b, T relative = detail::rounding<T>) const {
    const T mine = squaredNorm(), other = b.squaredNorm();
    return (*this - b).squaredNorm() <= relative * relative * (other < mine ? other : mine);
  }

  constexpr Row3<T> transpose() const { return Row3<T>(*this); }
  constexpr Diagonal3<T> asDiagonal() const { return Diagonal3<T>(*this); }
  constexpr Array3<T> array() const { return Array3<T>(*this); }
  template <class U>
  constexpr Vector3<U> cast() const {
    return {U(c_[0]), U(c_[1]), U(c_[2])};
  }

  constexpr Vector3& operator+=(const Vector3& b) & { return *this = *this + b; }
  constexpr Vector3& operator-=(const Vector3& b) & { return *this = *this - b; }
  constexpr Vector3& operator*=(T s) & { return *this = *this * s; }
  constexpr Vector3& operator/=(T s) & { return *this = *this / s; }
  friend constexpr Vector3 operator+(const Vector3& a, const Vector3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  }
  friend constexpr Vector3 operator-(const Vector3& a, const Vector3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  friend constexpr Vector3 operator-(const Vector3& a) { return {-a[0], -a[1], -a[2]}; }
  friend constexpr Vector3 operator*(T s, const Vector3& a) {
    return {s * a[0], s * a[1], s * a[2]};
  }
  friend constexpr Vector3 operator*(const Vector3& a, T s) {
    return {a[0] * s, a[1] * s, a[2] * s};
  }
  friend constexpr Vector3 operator/(const Vector3& a, T s) {
    return {a[0] / s, a[1] / s, a[2] / s};
  }
  friend constexpr bool operator==(const Vector3& a, const Vector3& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
  }

 private:
  T c_[3];
};

template <class T>
class Vector4 {
 public:
  using Scalar = T;
  Vector4() = default;  ///< its numbers are not set
  constexpr Vector4(const Vector4&) = default;
  constexpr Vector4& operator=(const Vector4&) & = default;
  constexpr Vector4(T x, T y, T z, T w) : c_{x, y, z, w} {}
  static constexpr Vector4 Zero() { return {0, 0, 0, 0}; }
  static constexpr Vector4 Ones() { return {1, 1, 1, 1}; }
  static constexpr Vector4 Constant(T s) { return {s, s, s, s}; }

  constexpr T& operator[](std::ptrdiff_t i) { return c_[i]; }
  constexpr const T& operator[](std::ptrdiff_t i) const { return c_[i]; }
  constexpr T& operator()(std::ptrdiff_t i) { return c_[i]; }
  constexpr const T& operator()(std::ptrdiff_t i) const { return c_[i]; }
  constexpr T& x() { return c_[0]; }
  constexpr T& y() { return c_[1]; }
  constexpr T& z() { return c_[2]; }
  constexpr T& w() { return c_[3]; }
  constexpr const T& x() const { return c_[0]; }
  constexpr const T& y() const { return c_[1]; }
  constexpr const T& z() const { return c_[2]; }
  constexpr const T& w() const { return c_[3]; }
  constexpr T* data() { return c_; }
  constexpr const T* data() const { return c_; }
  static constexpr std::ptrdiff_t size() { return 4; }
  /// The first N numbers, two or three.
  template <int N>
  constexpr auto head() const {
    if constexpr (N == 2) return Vector2<T>(c_[0], c_[1]);
    if constexpr (N == 3) return Vector3<T>(c_[0], c_[1], c_[2]);
  }

  constexpr T dot(const Vector4& b) const {
    return c_[0] * b[0] + c_[1] * b[1] + c_[2] * b[2] + c_[3] * b[3];
  }
  constexpr T squaredNorm() const { return dot(*this); }
  T norm() const { return std::sqrt(squaredNorm()); }
  Vector4 normalized() const {
    const T n = squaredNorm();
    return n > 0 ? *this / std::sqrt(n) : *this;
  }
  void normalize() & { *this = normalized(); }
  constexpr Vector4 cwiseProduct(const Vector4& b) const {
    return {c_[0] * b[0], c_[1] * b[1], c_[2] * b[2], c_[3] * b[3]};
  }
  Vector4 cwiseAbs() const {
    return {std::abs(c_[0]), std::abs(c_[1]), std::abs(c_[2]), std::abs(c_[3])};
  }
  constexpr T sum() const { return c_[0] + c_[1] + c_[2] + c_[3]; }
  constexpr T minCoeff() const {
    const Vector2<T> low = Vector2<T>(c_[0], c_[1]).cwiseMin({c_[2], c_[3]});
    return low.minCoeff();
  }
  constexpr T maxCoeff() const {
    const Vector2<T> high = Vector2<T>(c_[0], c_[1]).cwiseMax({c_[2], c_[3]});
    return high.maxCoeff();
  }
  bool allFinite() const {
    return std::isfinite(c_[0]) && std::isfinite(c_[1]) && std::isfinite(c_[2]) &&
           std::isfinite(c_[3]);
  }
  /// Whether the difference is small beside the shorter of the two.
  bool isApprox(const Vector4& b, T relative = detail::rounding<T>) const {
    const T mine = squaredNorm(), other = b.squaredNorm();
    return (*this - b).squaredNorm() <= relative * relative * (other < mine ? other : mine);
  }
  template <class U>
  constexpr Vector4<U> cast() const {
    return {U(c_[0]), U(c_[1]), U(c_[2]), U(c_[3])};
  }

  constexpr Vector4& operator+=(const Vector4& b) & { return *this = *this + b; }
  constexpr Vector4& operator-=(const Vector4& b) & { return *this = *this - b; }
  constexpr Vector4& operator*=(T s) & { return *this = *this * s; }
  constexpr Vector4& operator/=(T s) & { return *this = *this / s; }
  friend constexpr Vector4 operator+(const Vector4& a, const Vector4& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
  }
  friend constexpr Vector4 operator-(const Vector4& a, const Vector4& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
  }
  friend constexpr Vector4 operator-(const Vector4& a) { return {-a[0], -a[1], -a[2], -a[3]}; }
  friend constexpr Vector4 operator*(T s, const Vector4& a) {
    return {s * a[0], s * a[1], s * a[2], s * a[3]};
  }
  friend constexpr Vector4 operator*(const Vector4& a, T s) {
    return {a[0] * s, a[1] * s, a[2] * s, a[3] * s};
  }
  friend constexpr Vector4 operator/(const Vector4& a, T s) {
    return {a[0] / s, a[1] / s, a[2] / s, a[3] / s};
  }
  friend constexpr bool operator==(const Vector4& a, const Vector4& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
  }

 private:
  T c_[4];
};

}  // namespace tumble
