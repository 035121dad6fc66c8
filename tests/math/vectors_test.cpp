// The small vectors, matrices and quaternions of the house against Eigen's: what goes coefficient
// by coefficient has the same bits, zeros of both signs among them; sums, whose terms the two add
// in different orders, are compared with Eigen's in extended precision, within some roundings of
// the sum of the absolute terms.
#include "engine/core/random.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/matrix4.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <doctest/doctest.h>

using namespace tumble;

namespace {

using Long3 = Eigen::Matrix<long double, 3, 1>;
using LongMat3 = Eigen::Matrix<long double, 3, 3>;
using LongMat4 = Eigen::Matrix<long double, 4, 4>;

int vector_cases(int n) {
  return test::scaled_count(n, 200);
}

/// Numbers of all sizes, with zeros and small integers, so that some are equal.
class Numbers {
 public:
  explicit Numbers(uint64_t seed) : random_(seed) {}
  double one() {
    const uint32_t kind = random_.below(16);
    if (kind == 0) return 0.0;
    if (kind == 1) return -0.0;
    if (kind == 2) return double(random_.below(7)) - 3;
    const double significand = random_.uniform(-1, 1);
    return std::ldexp(significand, int(random_.below(41)) - 20);
  }
  Vec3 vector() {
    const double x = one(), y = one(), z = one();
    return {x, y, z};
  }
  Vec4 vector4() {
    const double x = one(), y = one(), z = one(), w = one();
    return {x, y, z, w};
  }
  Mat3 matrix() {
    const Vec3 x = vector(), y = vector(), z = vector();
    return Mat3::from_columns(x, y, z);
  }
  Quat quaternion() { return Quat(vector4()); }
  Mat4 matrix4() {
    const Vec4 x = vector4(), y = vector4(), z = vector4(), w = vector4();
    return Mat4::from_columns(x, y, z, w);
  }

 private:
  Random random_;
};

Eigen::Vector3d theirs(const Vec3& v) {
  return dense(v);
}
Eigen::Matrix3d theirs(const Mat3& m) {
  return dense(m);
}
Eigen::Quaterniond theirs(const Quat& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
LongMat4 theirs(const Mat4& m) {
  return Eigen::Map<const Eigen::Matrix4d>(m.data()).cast<long double>();
}

bool same(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}
bool same(const Vec3& a, const Eigen::Vector3d& b) {
  return same(a[0], b[0]) && same(a[1], b[1]) && same(a[2], b[2]);
}
bool same(const Mat3& a, const Eigen::Matrix3d& b) {
  return same(a.col(0), b.col(0)) && same(a.col(1), b.col(1)) && same(a.col(2), b.col(2));
}
bool same(const Quat& a, const Eigen::Quaterniond& b) {
  return same(a.w(), b.w()) && same(a.vec(), b.vec());
}

/// Whether `got` is right but for some roundings of numbers of size `size`.
template <class T>
bool near(T got, long double expected, long double size, int roundings = 4) {
  const long double epsilon = std::numeric_limits<T>::epsilon();
  return std::fabs((long double)(got)-expected) <= roundings * epsilon * size;
}
bool near(const Vec3& got, const Long3& expected, const Long3& size, int roundings = 4) {
  bool all = true;
  for (int i = 0; i < 3; ++i) all = all && near(got[i], expected[i], size[i], roundings);
  return all;
}
bool near(const Mat3& got, const LongMat3& expected, const LongMat3& size, int roundings = 4) {
  bool all = true;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) all = all && near(got(i, j), expected(i, j), size(i, j), roundings);
  return all;
}
/// Relative to what is expected, all coefficients by themselves.
bool near(const Vec3& got, const Long3& expected) {
  return near(got, expected, expected.cwiseAbs());
}

/// The products that make up a minor, all added: of a matrix without negative numbers.
long double minor_size(const LongMat3& m, int i, int j) {
  const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
  return m(i1, j1) * m(i2, j2) + m(i1, j2) * m(i2, j1);
}
/// The same of the determinant.
long double determinant_size(const LongMat3& m) {
  long double sum = 0;
  for (int j = 0; j < 3; ++j) sum += m(0, j) * minor_size(m, 0, j);
  return sum;
}

}  // namespace

TEST_CASE("vectors: what goes by coefficients has the bits of Eigen's") {
  Numbers numbers(1);
  for (int k = 0; k < vector_cases(20000); ++k) {
    const Vec3 a = numbers.vector(), b = numbers.vector();
    const double s = numbers.one();
    const Eigen::Vector3d x = theirs(a), y = theirs(b);
    REQUIRE(same(a + b, x + y));
    REQUIRE(same(a - b, x - y));
    REQUIRE(same(-a, -x));
    REQUIRE(same(s * a, s * x));
    REQUIRE(same(a * s, x * s));
    REQUIRE(same(a / s, x / s));
    REQUIRE(same(a + s * b, x + s * y));
    Vec3 c = a;
    c += b, c *= 3, c -= a, c /= 7;
    REQUIRE(same(c, (3 * (x + y) - x) / 7));
    REQUIRE(same(a.cross(b), x.cross(y)));
    REQUIRE(same(a.cwiseProduct(b), x.cwiseProduct(y)));
    REQUIRE(same(a.cwiseQuotient(b), x.cwiseQuotient(y)));
    REQUIRE(same(a.cwiseInverse(), x.cwiseInverse()));
    REQUIRE(same(a.cwiseAbs(), x.cwiseAbs()));
    REQUIRE(same(a.cwiseAbs2(), x.cwiseAbs2()));
    REQUIRE(same(a.cwiseAbs().cwiseSqrt(), x.cwiseAbs().cwiseSqrt()));
    REQUIRE(same(a.cwiseMin(b), x.cwiseMin(y)));
    REQUIRE(same(a.cwiseMax(b), x.cwiseMax(y)));
    REQUIRE(same(a.cwiseMin(s), x.cwiseMin(s)));
    REQUIRE(same(a.cwiseMax(s), x.cwiseMax(s)));
    REQUIRE(a.minCoeff() == x.minCoeff());
    REQUIRE(a.maxCoeff() == x.maxCoeff());
    int mine = -1, other = -1;
    REQUIRE(a.minCoeff(&mine) == x.minCoeff(&other));
    REQUIRE(mine == other);
    REQUIRE(a.maxCoeff(&mine) == x.maxCoeff(&other));
    REQUIRE(mine == other);
    REQUIRE((a == b) == (x == y));
    REQUIRE((a != b) == (x != y));
    REQUIRE(a == small_vector(x));
    REQUIRE(a.isZero() == x.isZero());
    REQUIRE(a.isZero(std::fabs(s)) == x.isZero(std::fabs(s)));
    REQUIRE(a.isApprox(b, 0.5) == x.isApprox(y, 0.5));
    REQUIRE((a.head<2>()[1] == a[1] && a.tail<2>()[1] == a[2]));
  }
  REQUIRE(same(Vec3::Unit(1), Eigen::Vector3d::UnitY()));
  REQUIRE(same(Vec3::UnitX() + 2 * Vec3::Unit(2), Eigen::Vector3d(1, 0, 2)));
  for (int i = 0; i < 3; ++i)
    for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)}) {
      Vec3 a = Vec3::Ones();
      REQUIRE(a.allFinite());
      REQUIRE(!a.hasNaN());
      a[i] = bad;
      REQUIRE(!a.allFinite());
      REQUIRE(a.hasNaN() == std::isnan(bad));
      REQUIRE(!a.isZero(10));
      REQUIRE(!(Vec3::Zero() == a));
    }
}

TEST_CASE("arrays: by coefficients and masks as Eigen's") {
  Numbers numbers(2);
  for (int k = 0; k < vector_cases(20000); ++k) {
    const Vec3 a = numbers.vector(), b = numbers.vector();
    const double s = numbers.one();
    const Eigen::Array3d x = theirs(a), y = theirs(b);
    REQUIRE(same(Vec3(a.array() + s), (x + s).matrix()));
    REQUIRE(same(Vec3(a.array() - s), (x - s).matrix()));
    REQUIRE(same(Vec3(a.array() * b.array()), (x * y).matrix()));
    REQUIRE(same(Vec3(a.array() / b.array()), (x / y).matrix()));
    REQUIRE(same(Vec3(-a.array()), (-x).matrix()));
    REQUIRE(same(Vec3(a.array().abs()), x.abs().matrix()));
    // Eigen's zeros have not the sign that the standard library's have: the ceiling of -0.5.
    REQUIRE(Vec3(a.array().floor()) == small_vector(x.floor().matrix()));
    REQUIRE(Vec3(a.array().ceil()) == small_vector(x.ceil().matrix()));
    REQUIRE(Vec3(a.array().round()) == small_vector(x.round().matrix()));
    REQUIRE(same(Vec3(a.array().square()), x.square().matrix()));
    REQUIRE(same(Vec3(a.array().inverse()), x.inverse().matrix()));
    REQUIRE(same(Vec3(a.array().min(b.array())), x.min(y).matrix()));
    REQUIRE(same(Vec3(a.array().max(s)), x.max(s).matrix()));
    const auto masks = [](const Mask3& mine, const auto& other) {
      return mine.all() == other.all() && mine.any() == other.any() &&
             mine.count() == int(other.count()) && mine.x == other(0) && mine.y == other(1) &&
             mine.z == other(2);
    };
    REQUIRE(masks(a.array() < b.array(), (x < y).eval()));
    REQUIRE(masks(a.array() <= b.array(), (x <= y).eval()));
    REQUIRE(masks(a.array() > b.array(), (x > y).eval()));
    REQUIRE(masks(a.array() >= s, (x >= s).eval()));
    REQUIRE(masks(a.array() == b.array(), (x == y).eval()));
    REQUIRE(masks(a.array() != b.array(), (x != y).eval()));
    REQUIRE(masks(a.array() < b.array() && a.array() > s, (x < y && x > s).eval()));
    REQUIRE(masks(a.array() < b.array() || a.array() > s, (x < y || x > s).eval()));
  }
}

TEST_CASE("vectors: sums, lengths and directions are Eigen's but for rounding") {
  Numbers numbers(3);
  for (int k = 0; k < vector_cases(20000); ++k) {
    const Vec3 a = numbers.vector(), b = numbers.vector();
    const Long3 x = theirs(a).cast<long double>(), y = theirs(b).cast<long double>();
    REQUIRE(near(a.dot(b), x.dot(y), x.cwiseAbs().dot(y.cwiseAbs())));
    REQUIRE(near(a.transpose() * b, x.dot(y), x.cwiseAbs().dot(y.cwiseAbs())));
    REQUIRE(near(a.sum(), x.sum(), x.cwiseAbs().sum()));
    REQUIRE(near(a.mean(), x.mean(), x.cwiseAbs().mean()));
    REQUIRE(near(a.prod(), x.prod(), std::fabs(x.prod())));
    REQUIRE(near(a.squaredNorm(), x.squaredNorm(), x.squaredNorm()));
    REQUIRE(near(a.norm(), x.norm(), x.norm()));
    REQUIRE(near(a.stableNorm(), x.norm(), x.norm()));
    REQUIRE(near(a.normalized(), x.normalized()));
    Vec3 unit = a;
    unit.normalize();
    REQUIRE(unit == a.normalized());
    // Which of two ways is taken depends on the precision, so this is compared in double.
    if (a != Vec3::Zero())
      REQUIRE(near(a.unitOrthogonal(), theirs(a).unitOrthogonal().cast<long double>().eval()));
  }
  // Where squares overflow or vanish.
  for (const double size : {0x1p-1000, 0x1p-1060, 0x1p600, 0x1p1020})
    for (const Vec3& v : {Vec3(3, 4, 12), Vec3(-3, 4, 12), Vec3(12, 3, -4)})
      REQUIRE(near(Vec3(size * v / 16).stableNorm() / size, 13.0L / 16, 1));
  REQUIRE(Vec3::Zero().stableNorm() == 0);
  REQUIRE(Vec3::Zero().normalized() == Vec3::Zero());
}

TEST_CASE("matrices: what goes by coefficients has the bits of Eigen's") {
  Numbers numbers(4);
  for (int k = 0; k < vector_cases(10000); ++k) {
    const Mat3 A = numbers.matrix(), B = numbers.matrix();
    const Vec3 a = numbers.vector(), b = numbers.vector();
    const double s = numbers.one();
    const Eigen::Matrix3d X = theirs(A), Y = theirs(B);
    const Eigen::Vector3d x = theirs(a), y = theirs(b);
    REQUIRE(same(A + B, X + Y));
    REQUIRE(same(A - B, X - Y));
    REQUIRE(same(-A, -X));
    REQUIRE(same(s * A, s * X));
    REQUIRE(same(A * s, X * s));
    REQUIRE(same(A / s, X / s));
    REQUIRE(same(A.transpose(), X.transpose()));
    REQUIRE(same(A.cwiseAbs(), X.cwiseAbs()));
    REQUIRE(same(A.cwiseProduct(B), X.cwiseProduct(Y)));
    REQUIRE(same(A * a.asDiagonal(), X * x.asDiagonal()));
    REQUIRE(same(a.asDiagonal() * A, x.asDiagonal() * X));
    REQUIRE(same(a.asDiagonal() * b, x.asDiagonal() * y));
    REQUIRE(same(Mat3(a.asDiagonal()), Eigen::Matrix3d(x.asDiagonal())));
    REQUIRE(same(a * b.transpose(), x * y.transpose()));
    REQUIRE(same(A.diagonal(), X.diagonal()));
    for (int i = 0; i < 3; ++i) {
      REQUIRE(same(A.row(i).transpose(), X.row(i).transpose()));
      REQUIRE(same(A.col(i), X.col(i)));
    }
    REQUIRE(A.maxCoeff() == X.maxCoeff());
    REQUIRE(A.minCoeff() == X.minCoeff());
    REQUIRE(A.isZero(std::fabs(s)) == X.isZero(std::fabs(s)));
    REQUIRE(A.isApprox(B, 0.5) == X.isApprox(Y, 0.5));
    REQUIRE((A == B) == (X == Y));
    REQUIRE(A == small_matrix(X));
    REQUIRE(A == Mat3::from_rows(A.row(0).transpose(), A.row(1).transpose(), A.row(2).transpose()));
    REQUIRE(A ==
            Mat3(A(0, 0), A(0, 1), A(0, 2), A(1, 0), A(1, 1), A(1, 2), A(2, 0), A(2, 1), A(2, 2)));
    Mat3 C = A;
    C.set_row(1, a), C.col(2) = b;
    Eigen::Matrix3d Z = X;
    Z.row(1) = x.transpose(), Z.col(2) = y;
    REQUIRE(same(C, Z));
  }
  REQUIRE(same(Mat3::Identity(), Eigen::Matrix3d::Identity()));
  REQUIRE(same(Mat3::Constant(2) - Mat3::Zero(), Eigen::Matrix3d::Constant(2)));
}

TEST_CASE("matrices: products, norms, determinants and inverses are Eigen's but for rounding") {
  Numbers numbers(5);
  int inverted = 0;
  const int count = vector_cases(10000);
  for (int k = 0; k < count; ++k) {
    const Mat3 A = numbers.matrix(), B = numbers.matrix();
    const Vec3 a = numbers.vector();
    const LongMat3 X = theirs(A).cast<long double>(), Y = theirs(B).cast<long double>();
    const Long3 x = theirs(a).cast<long double>();
    const LongMat3 U = X.cwiseAbs(), V = Y.cwiseAbs();
    const Long3 u = x.cwiseAbs();
    REQUIRE(near(A * a, X * x, U * u));
    REQUIRE(near(A.transpose() * a, X.transpose() * x, U.transpose() * u));
    REQUIRE(near((a.transpose() * A).transpose(), X.transpose() * x, U.transpose() * u));
    REQUIRE(near(A * B, X * Y, U * V));
    REQUIRE(near(A.transpose() * B, X.transpose() * Y, U.transpose() * V));
    REQUIRE(near(A * B * A.transpose(), X * Y * X.transpose(), U * V * U.transpose(), 8));
    REQUIRE(near(A.trace(), X.trace(), U.trace()));
    REQUIRE(near(A.sum(), X.sum(), U.sum(), 8));
    REQUIRE(near(A.squaredNorm(), X.squaredNorm(), X.squaredNorm(), 8));
    REQUIRE(near(A.norm(), X.norm(), X.norm(), 8));
    const long double size = determinant_size(U), determinant = X.determinant();
    REQUIRE(near(A.determinant(), determinant, size, 8));
    if (std::fabs(determinant) < 1e-12L * size || determinant == 0) continue;
    // Rounding in a minor counts by its products, that in the determinant by its own.
    ++inverted;
    const LongMat3 inverse = X.inverse();
    LongMat3 sizes;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        sizes(i, j) =
            (minor_size(U, j, i) + std::fabs(inverse(i, j)) * size) / std::fabs(determinant);
    REQUIRE(near(A.inverse(), inverse, sizes, 8));
  }
  REQUIRE(inverted > count / 2);
  REQUIRE(!Mat3::Zero().inverse().allFinite());
}

TEST_CASE("quaternions: products, turns and conversions are Eigen's") {
  Numbers numbers(6);
  int traces = 0;
  const int count = vector_cases(20000);
  for (int k = 0; k < count; ++k) {
    const Quat p = numbers.quaternion(), q = numbers.quaternion();
    const Vec3 a = numbers.vector();
    const Eigen::Quaterniond P = theirs(p), Q = theirs(q);
    const Eigen::Quaternion<long double> M = P.cast<long double>(), N = Q.cast<long double>();
    REQUIRE(same(p * q, P * Q));
    REQUIRE(same(p * a, P * theirs(a)));
    REQUIRE(same(p.conjugate(), P.conjugate()));
    REQUIRE(same(p.toRotationMatrix(), P.toRotationMatrix()));
    REQUIRE((p == q) == (P.coeffs() == Q.coeffs()));
    REQUIRE(p == Quat(p.w(), p.vec()));
    REQUIRE(near(p.dot(q), M.dot(N), M.coeffs().cwiseAbs().dot(N.coeffs().cwiseAbs())));
    REQUIRE(near(p.squaredNorm(), M.squaredNorm(), M.squaredNorm()));
    REQUIRE(near(p.norm(), M.norm(), M.norm()));
    if (p.norm() == 0 || q.norm() == 0) continue;
    const Quat unit = p.normalized(), back = p.inverse();
    REQUIRE(near(unit.vec(), M.normalized().vec()));
    REQUIRE(near(unit.w(), M.normalized().w(), std::fabs(M.normalized().w())));
    REQUIRE(near(back.vec(), M.inverse().vec()));
    REQUIRE(near(back.w(), M.inverse().w(), std::fabs(M.inverse().w())));
    REQUIRE(near(p.angularDistance(q), M.angularDistance(N), 1, 8));
    // From a matrix: all four ways, and with the same trace the same bits.
    const Mat3 R = unit.toRotationMatrix();
    const Eigen::Quaterniond expected(theirs(R));
    if (same(R.trace(), theirs(R).trace())) {
      ++traces;
      REQUIRE(same(Quat(R), expected));
    }
    REQUIRE(near(Quat(R).vec(), expected.vec().cast<long double>(), Long3::Ones(), 8));
    REQUIRE(near(Quat(R).w(), expected.w(), 1, 8));
  }
  REQUIRE(traces > count / 4);
  REQUIRE(Quat(0, 0, 0, 0).inverse() == Quat(0, 0, 0, 0));
  REQUIRE(same(Quat::Identity(), Eigen::Quaterniond::Identity()));
}

TEST_CASE("vectors of two and four, and of floats, are Eigen's") {
  Numbers numbers(7);
  for (int k = 0; k < vector_cases(20000); ++k) {
    const Vec4 a = numbers.vector4(), b = numbers.vector4();
    const double s = numbers.one();
    const Eigen::Vector4d x(a[0], a[1], a[2], a[3]), y(b[0], b[1], b[2], b[3]);
    const Eigen::Vector4d sum = x + s * y;
    const auto X = x.cast<long double>().eval(), Y = y.cast<long double>().eval();
    for (int i = 0; i < 4; ++i) {
      REQUIRE(same((a + s * b)[i], sum[i]));
      REQUIRE(same((a - b / s)[i], (x - y / s)[i]));
      REQUIRE(same(a.cwiseProduct(b)[i], x.cwiseProduct(y)[i]));
      REQUIRE(same(a.cwiseAbs()[i], x.cwiseAbs()[i]));
      REQUIRE(near(a.normalized()[i], X.normalized()[i], std::fabs(X.normalized()[i])));
    }
    REQUIRE(near(a.dot(b), X.dot(Y), X.cwiseAbs().dot(Y.cwiseAbs())));
    REQUIRE(near(a.sum(), X.sum(), X.cwiseAbs().sum()));
    REQUIRE(near(a.norm(), X.norm(), X.norm()));
    REQUIRE(a.maxCoeff() == x.maxCoeff());
    REQUIRE(a.minCoeff() == x.minCoeff());
    REQUIRE((a == b) == (x == y));
    REQUIRE(a.isApprox(b, 0.5) == x.isApprox(y, 0.5));

    const Vec2 c = a.head<2>(), d = b.head<2>();
    const Eigen::Vector2d z = x.head<2>(), w = y.head<2>();
    for (int i = 0; i < 2; ++i) {
      REQUIRE(same((c + s * d)[i], (z + s * w)[i]));
      REQUIRE(same((c - d / s)[i], (z - w / s)[i]));
      REQUIRE(same(c.cwiseProduct(d)[i], z.cwiseProduct(w)[i]));
      REQUIRE(same(c.cwiseMin(d)[i], std::min(z[i], w[i])));
      REQUIRE(same(c.cwiseMax(d)[i], std::max(z[i], w[i])));
      REQUIRE(near(c.normalized()[i], X.head<2>().normalized()[i], 1));
    }
    REQUIRE(c.maxCoeff() == z.maxCoeff());
    REQUIRE(c.minCoeff() == z.minCoeff());
    REQUIRE(near(c.dot(d), X.head<2>().dot(Y.head<2>()),
                 X.head<2>().cwiseAbs().dot(Y.head<2>().cwiseAbs())));
    REQUIRE(near(c.norm(), X.head<2>().norm(), X.head<2>().norm()));

    const Vec3f e = a.head<3>().cast<float>(), f = b.head<3>().cast<float>();
    const Eigen::Vector3f g = x.head<3>().cast<float>(), h = y.head<3>().cast<float>();
    const Long3 G = g.cast<long double>(), H = h.cast<long double>();
    REQUIRE(near(e.dot(f), G.dot(H), G.cwiseAbs().dot(H.cwiseAbs())));
    REQUIRE(near(e.norm(), G.norm(), G.norm()));
    for (int i = 0; i < 3; ++i) {
      REQUIRE((e + 3 * f)[i] == (g + 3 * h)[i]);
      REQUIRE(e.cross(f)[i] == g.cross(h)[i]);
    }
  }
}

TEST_CASE("matrices of four by four: products, inverses and affine maps") {
  Numbers numbers(8);
  int inverted = 0;
  const int count = vector_cases(10000);
  for (int k = 0; k < count; ++k) {
    const Mat4 A = numbers.matrix4(), B = numbers.matrix4();
    const Vec4 a = numbers.vector4();
    const LongMat4 X = theirs(A), Y = theirs(B);
    const LongMat4 product = X * Y, products = X.cwiseAbs() * Y.cwiseAbs();
    const Eigen::Matrix<long double, 4, 1> x(a[0], a[1], a[2], a[3]);
    const Eigen::Matrix<long double, 4, 1> image = X * x, terms = X.cwiseAbs() * x.cwiseAbs();
    for (int i = 0; i < 4; ++i) {
      REQUIRE(near((A * a)[i], image[i], terms[i]));
      for (int j = 0; j < 4; ++j) {
        REQUIRE(near((A * B)(i, j), product(i, j), products(i, j)));
        REQUIRE(A.transpose()(i, j) == A(j, i));
        REQUIRE(A.row(i)[j] == A(i, j));
        REQUIRE(A.col(j)[i] == A(i, j));
        REQUIRE(same(A.data()[4 * j + i], A(i, j)));
        if (i < 3 && j < 3) REQUIRE(A.linear()(i, j) == A(i, j));
      }
    }
    const LongMat4 inverse = X.inverse();
    const long double condition = X.norm() * inverse.norm();
    if (!(condition < 1e9L)) continue;
    ++inverted;
    const Mat4 found = A.inverse();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        REQUIRE(near(found(i, j), inverse(i, j), condition * inverse.norm(), 8));
        REQUIRE(near((A * found)(i, j), i == j, condition * condition, 8));
      }
  }
  REQUIRE(inverted > count / 20);

  Random r(9);
  for (int k = 0; k < vector_cases(10000); ++k) {
    const auto draw = [&r] {
      const double x = r.uniform(-1, 1), y = r.uniform(-1, 1), z = r.uniform(-1, 1);
      return Vec3(x, y, z);
    };
    const Vec3 axis = draw(), offset = 10 * draw(), p = draw();
    const Mat3 R = Quat(r.uniform(-1, 1), axis).normalized().toRotationMatrix();
    const Mat4 A = Mat4::affine(R, offset);
    REQUIRE(A.linear() == R);
    REQUIRE(A.row(3) == Vec4(0, 0, 0, 1));
    REQUIRE(A.col(3) == Vec4(offset[0], offset[1], offset[2], 1));
    const Vec4 image = A * Vec4(p[0], p[1], p[2], 1);
    REQUIRE((image.head<3>() - (R * p + offset)).norm() < 1e-14);
    REQUIRE(image.w() == 1);
    // Numbers of one size are inverted to the last digits that their condition leaves.
    Mat4 B;
    for (int i = 0; i < 16; ++i) B(i % 4, i / 4) = r.uniform(-1, 1);
    const Mat4 inverse = B.inverse();
    const LongMat4 Y = theirs(B);
    const long double condition = Y.norm() * Y.inverse().norm();
    const LongMat4 one = theirs(inverse * B), other = theirs(B * inverse);
    REQUIRE((one - LongMat4::Identity()).norm() < 1e-14L * condition);
    REQUIRE((other - LongMat4::Identity()).norm() < 1e-14L * condition);
    // R^T (x - offset) undoes it.
    const Mat4 back = A.inverse(),
               expected = Mat4::affine(R.transpose(), -(R.transpose() * offset));
    for (int j = 0; j < 4; ++j) REQUIRE((back.col(j) - expected.col(j)).norm() < 1e-13);
  }
  for (int j = 0; j < 4; ++j) {
    REQUIRE(Mat4::Identity().col(j) == Mat4::Identity().inverse().col(j));
    REQUIRE(Mat4::Zero().col(j) == Vec4::Zero());
  }
}
