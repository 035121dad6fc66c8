#pragma once
#include "engine/math/array3.hpp"
#include "engine/math/vector.hpp"

namespace tumble {

template <class T>
class Matrix3;

/// A row vector: a transposed column, or a row of a matrix.
template <class T>
class Row3 {
 public:
  constexpr explicit Row3(const Vector3<T>& v) : v_(v) {}
  constexpr Row3(T x, T y, T z) : v_(x, y, z) {}
  constexpr const Vector3<T>& transpose() const { return v_; }
  constexpr const T& operator[](std::ptrdiff_t i) const { return v_[i]; }
  constexpr const T& operator()(std::ptrdiff_t i) const { return v_[i]; }
  constexpr T dot(const Vector3<T>& b) const { return v_.dot(b); }
  constexpr T dot(const Row3& b) const { return v_.dot(b.v_); }
  constexpr T squaredNorm() const { return v_.squaredNorm(); }
  T norm() const { return v_.norm(); }
  constexpr T sum() const { return v_.sum(); }
  constexpr T maxCoeff() const { return v_.maxCoeff(); }
  Row3 cwiseAbs() const { return Row3(v_.cwiseAbs()); }

  friend constexpr Row3 operator+(const Row3& a, const Row3& b) { return Row3(a.v_ + b.v_); }
  friend constexpr Row3 operator-(const Row3& a, const Row3& b) { return Row3(a.v_ - b.v_); }
  friend constexpr Row3 operator-(const Row3& a) { return Row3(-a.v_); }
  friend constexpr Row3 operator*(T s, const Row3& a) { return Row3(s * a.v_); }
  friend constexpr Row3 operator*(const Row3& a, T s) { return Row3(a.v_ * s); }
  friend constexpr Row3 operator/(const Row3& a, T s) { return Row3(a.v_ / s); }
  friend constexpr T operator*(const Row3& a, const Vector3<T>& b) { return a.v_.dot(b); }
  friend constexpr Row3 operator*(const Row3& a, const Matrix3<T>& m) {
    return Row3(a.v_.dot(m.col(0)), a.v_.dot(m.col(1)), a.v_.dot(m.col(2)));
  }
  /// The outer product a b^T.
  friend constexpr Matrix3<T> operator*(const Vector3<T>& a, const Row3& b) {
    return Matrix3<T>::from_columns(a * b[0], a * b[1], a * b[2]);
  }
  friend constexpr bool operator==(const Row3& a, const Row3& b) { return a.v_ == b.v_; }

 private:
  Vector3<T> v_;
};

/// A diagonal matrix, stored as its diagonal: Vector3::asDiagonal().
template <class T>
class Diagonal3 {
 public:
  constexpr explicit Diagonal3(const Vector3<T>& v) : v_(v) {}
  constexpr const Vector3<T>& diagonal() const { return v_; }
  friend constexpr Vector3<T> operator*(const Diagonal3& d, const Vector3<T>& a) {
    return d.v_.cwiseProduct(a);
  }
  friend constexpr Matrix3<T> operator*(const Matrix3<T>& m, const Diagonal3& d) {
    return Matrix3<T>::from_columns(m.col(0) * d.v_[0], m.col(1) * d.v_[1], m.col(2) * d.v_[2]);
  }
  friend constexpr Matrix3<T> operator*(const Diagonal3& d, const Matrix3<T>& m) {
    return Matrix3<T>::from_columns(d * m.col(0), d * m.col(1), d * m.col(2));
  }

 private:
  Vector3<T> v_;
};

/// A 3 x 3 matrix, stored by columns.
template <class T>
class Matrix3 {
 public:
  using Scalar = T;
  using Vector = Vector3<T>;
  Matrix3() = default;  ///< its numbers are not set
  constexpr Matrix3(const Matrix3&) = default;
  constexpr Matrix3& operator=(const Matrix3&) & = default;
  /// Entries in row order.
  constexpr Matrix3(T xx, T xy, T xz, T yx, T yy, T yz, T zx, T zy, T zz)
      : c_{{xx, yx, zx}, {xy, yy, zy}, {xz, yz, zz}} {}
  constexpr Matrix3(const Diagonal3<T>& d)
      : Matrix3(d.diagonal()[0], 0, 0, 0, d.diagonal()[1], 0, 0, 0, d.diagonal()[2]) {}
  static constexpr Matrix3 from_columns(const Vector& x, const Vector& y, const Vector& z) {
    Matrix3 m;
    m.c_[0] = x, m.c_[1] = y, m.c_[2] = z;
    return m;
  }
  static constexpr Matrix3 from_rows(const Vector& x, const Vector& y, const Vector& z) {
    return {x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]};
  }
  static constexpr Matrix3 Zero() { return Constant(0); }
  static constexpr Matrix3 Constant(T s) {
    return from_columns(Vector::Constant(s), Vector::Constant(s), Vector::Constant(s));
  }
  static constexpr Matrix3 Identity() { return {1, 0, 0, 0, 1, 0, 0, 0, 1}; }

  constexpr T& operator()(std::ptrdiff_t row, std::ptrdiff_t column) { return c_[column][row]; }
  constexpr const T& operator()(std::ptrdiff_t row, std::ptrdiff_t column) const {
    return c_[column][row];
  }
  constexpr Vector& col(std::ptrdiff_t j) { return c_[j]; }
  constexpr const Vector& col(std::ptrdiff_t j) const { return c_[j]; }
  constexpr Row3<T> row(std::ptrdiff_t i) const { return {c_[0][i], c_[1][i], c_[2][i]}; }
  constexpr void set_row(std::ptrdiff_t i, const Vector& v) & {
    c_[0][i] = v[0], c_[1][i] = v[1], c_[2][i] = v[2];
  }
  constexpr Vector diagonal() const { return {c_[0][0], c_[1][1], c_[2][2]}; }
  /// The nine numbers, column by column.
  constexpr T* data() { return c_[0].data(); }
  constexpr const T* data() const { return c_[0].data(); }
  static constexpr std::ptrdiff_t size() { return 9; }

  constexpr void setZero() & { *this = Zero(); }
  constexpr void setIdentity() & { *this = Identity(); }

  constexpr Matrix3 transpose() const { return from_rows(c_[0], c_[1], c_[2]); }
  constexpr T trace() const { return diagonal().sum(); }
  constexpr T determinant() const {
    const auto product = [&](int a, int b, int c) {
      return (*this)(0, a) * ((*this)(1, b) * (*this)(2, c) - (*this)(1, c) * (*this)(2, b));
    };
    return product(0, 1, 2) - product(1, 0, 2) + product(2, 0, 1);
  }
  /// By cofactors; not finite where the matrix is singular.
  constexpr Matrix3 inverse() const {
    const Vector first(cofactor(0, 0), cofactor(1, 0), cofactor(2, 0));
    const T s = T(1) / first.dot(c_[0]);
    return {first[0] * s,       first[1] * s,       first[2] * s,
            cofactor(0, 1) * s, cofactor(1, 1) * s, cofactor(2, 1) * s,
            cofactor(0, 2) * s, cofactor(1, 2) * s, cofactor(2, 2) * s};
  }

  /// Frobenius' norm and its square.
  constexpr T squaredNorm() const { return cwiseProduct(*this).sum(); }
  T norm() const { return std::sqrt(squaredNorm()); }
  constexpr T sum() const { return c_[0].sum() + c_[1].sum() + c_[2].sum(); }
  constexpr T minCoeff() const {
    return Vector(c_[0].minCoeff(), c_[1].minCoeff(), c_[2].minCoeff()).minCoeff();
  }
  constexpr T maxCoeff() const {
    return Vector(c_[0].maxCoeff(), c_[1].maxCoeff(), c_[2].maxCoeff()).maxCoeff();
  }
  Matrix3 cwiseAbs() const {
    return from_columns(c_[0].cwiseAbs(), c_[1].cwiseAbs(), c_[2].cwiseAbs());
  }
  constexpr Matrix3 cwiseProduct(const Matrix3& b) const {
    return from_columns(c_[0].cwiseProduct(b.c_[0]), c_[1].cwiseProduct(b.c_[1]),
                        c_[2].cwiseProduct(b.c_[2]));
  }
  bool allFinite() const { return c_[0].allFinite() && c_[1].allFinite() && c_[2].allFinite(); }
  /// Whether no absolute value exceeds `most`.
  bool isZero(T most = detail::rounding<T>) const {
    return c_[0].isZero(most) && c_[1].isZero(most) && c_[2].isZero(most);
  }
  bool isApprox(const Matrix3& b, T relative = detail::rounding<T>) const {
    const T mine = squaredNorm(), other = b.squaredNorm();
    return (*this - b).squaredNorm() <= relative * relative * (other < mine ? other : mine);
  }
  template <class U>
  constexpr Matrix3<U> cast() const {
    return Matrix3<U>::from_columns(c_[0].template cast<U>(), c_[1].template cast<U>(),
                                    c_[2].template cast<U>());
  }

  constexpr Matrix3& operator+=(const Matrix3& b) & { return *this = *this + b; }
  constexpr Matrix3& operator-=(const Matrix3& b) & { return *this = *this - b; }
  constexpr Matrix3& operator*=(T s) & { return *this = *this * s; }
  constexpr Matrix3& operator/=(T s) & { return *this = *this / s; }
  friend constexpr Matrix3 operator+(const Matrix3& a, const Matrix3& b) {
    return from_columns(a.c_[0] + b.c_[0], a.c_[1] + b.c_[1], a.c_[2] + b.c_[2]);
  }
  friend constexpr Matrix3 operator-(const Matrix3& a, const Matrix3& b) {
    return from_columns(a.c_[0] - b.c_[0], a.c_[1] - b.c_[1], a.c_[2] - b.c_[2]);
  }
  friend constexpr Matrix3 operator-(const Matrix3& a) {
    return from_columns(-a.c_[0], -a.c_[1], -a.c_[2]);
  }
  friend constexpr Matrix3 operator*(T s, const Matrix3& a) {
    return from_columns(s * a.c_[0], s * a.c_[1], s * a.c_[2]);
  }
  friend constexpr Matrix3 operator*(const Matrix3& a, T s) {
    return from_columns(a.c_[0] * s, a.c_[1] * s, a.c_[2] * s);
  }
  friend constexpr Matrix3 operator/(const Matrix3& a, T s) {
    return from_columns(a.c_[0] / s, a.c_[1] / s, a.c_[2] / s);
  }
  friend constexpr Vector operator*(const Matrix3& m, const Vector& a) {
    return {m.row(0).dot(a), m.row(1).dot(a), m.row(2).dot(a)};
  }
  friend constexpr Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
    return from_columns(a * b.c_[0], a * b.c_[1], a * b.c_[2]);
  }
  friend constexpr bool operator==(const Matrix3& a, const Matrix3& b) {
    return a.c_[0] == b.c_[0] && a.c_[1] == b.c_[1] && a.c_[2] == b.c_[2];
  }

 private:
  constexpr T cofactor(int i, int j) const {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return (*this)(i1, j1) * (*this)(i2, j2) - (*this)(i1, j2) * (*this)(i2, j1);
  }

  Vector c_[3];
};

}  // namespace tumble
