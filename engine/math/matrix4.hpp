#pragma once
#include "engine/math/matrix3.hpp"

namespace tumble {

/// A 4 x 4 matrix, stored by columns as OpenGL expects, for transforms of homogeneous coordinates.
template <class T>
class Matrix4 {
 public:
  using Vector = Vector4<T>;
  Matrix4() = default;  ///< its numbers are not set
  constexpr Matrix4(const Matrix4&) = default;
  constexpr Matrix4& operator=(const Matrix4&) & = default;
  static constexpr Matrix4 from_columns(const Vector& x, const Vector& y, const Vector& z,
                                        const Vector& w) {
    Matrix4 m;
    m.c_[0] = x, m.c_[1] = y, m.c_[2] = z, m.c_[3] = w;
    return m;
  }
  static constexpr Matrix4 Zero() {
    return from_columns(Vector::Zero(), Vector::Zero(), Vector::Zero(), Vector::Zero());
  }
  static constexpr Matrix4 Identity() {
    return from_columns({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
  }
  /// The map x -> linear x + offset.
  static constexpr Matrix4 affine(const Matrix3<T>& linear, const Vector3<T>& offset) {
    Matrix4 m = Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) m(i, j) = linear(i, j);
      m(i, 3) = offset[i];
    }
    return m;
  }

  constexpr T& operator()(std::ptrdiff_t row, std::ptrdiff_t column) { return c_[column][row]; }
  constexpr const T& operator()(std::ptrdiff_t row, std::ptrdiff_t column) const {
    return c_[column][row];
  }
  constexpr Vector row(std::ptrdiff_t i) const { return {c_[0][i], c_[1][i], c_[2][i], c_[3][i]}; }
  constexpr const Vector& col(std::ptrdiff_t j) const { return c_[j]; }
  /// The upper left part, three by three.
  constexpr Matrix3<T> linear() const {
    return Matrix3<T>::from_columns(c_[0].template head<3>(), c_[1].template head<3>(),
                                    c_[2].template head<3>());
  }
  /// The sixteen numbers, column by column.
  constexpr const T* data() const { return c_[0].data(); }
  static constexpr std::ptrdiff_t size() { return 16; }

  constexpr Matrix4 transpose() const { return from_columns(row(0), row(1), row(2), row(3)); }
  /// By elimination with partial pivoting; not finite if singular.
  Matrix4 inverse() const {
    Matrix4 a = transpose(), out = Identity();  // by rows: a column of `a` is a row of this
    for (int k = 0; k < 4; ++k) {
      int pivot = k;
      for (int i = k + 1; i < 4; ++i)
        if (std::abs(a.c_[i][k]) > std::abs(a.c_[pivot][k])) pivot = i;
      const Vector row = a.c_[pivot] / a.c_[pivot][k], answer = out.c_[pivot] / a.c_[pivot][k];
      a.c_[pivot] = a.c_[k], out.c_[pivot] = out.c_[k];
      a.c_[k] = row, out.c_[k] = answer;
      for (int i = 0; i < 4; ++i) {
        if (i == k) continue;
        const T share = a.c_[i][k];
        a.c_[i] -= share * row;
        out.c_[i] -= share * answer;
      }
    }
    return out.transpose();
  }

  friend constexpr Vector operator*(const Matrix4& m, const Vector& a) {
    return {m.row(0).dot(a), m.row(1).dot(a), m.row(2).dot(a), m.row(3).dot(a)};
  }
  friend constexpr Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
    return from_columns(a * b.c_[0], a * b.c_[1], a * b.c_[2], a * b.c_[3]);
  }

 private:
  Vector c_[4];
};

using Mat4 = Matrix4<double>;

}  // namespace tumble
