#include "engine/geometry/primitive_tests/exact_nearest.hpp"

#include "engine/geometry/predicates/filtered.hpp"

#include <limits>

namespace tumble {
namespace {

/// The vectors of a feature; w goes from its corner to the point.
template <class T>
struct Frame {
  Triple<T> w, u, v;

  Frame(const Vec3& p, const ExactFeature& f)
      : w(exact_difference<T>(p, f.corner[0]) -
          (exact_sum<T>(f.corner[1], f.corner[2]) + Triple<T>::of(f.corner[3]))),
        u(exact_difference<T>(f.u[0], f.u[1])),
        v(exact_difference<T>(f.v[0], f.v[1])) {}
};

/// Exact sign of an expression of a feature's frame.
template <class Expression>
int sign_in_frame(const Vec3& p, const ExactFeature& f, const Expression& expression) {
  return exact_sign([&](auto number) { return expression(Frame<decltype(number)>(p, f)); });
}

/// Whether the projection of p falls within the feature: edges exclude their ends, faces include
/// their border. Features without extent contain nothing.
bool projects_into(const Vec3& p, const ExactFeature& f) {
  const auto sign = [&](const auto& expression) { return sign_in_frame(p, f, expression); };
  if (f.dimension == 0) return true;
  if (f.dimension == 1) {
    return sign([](const auto& k) { return k.w.dot(k.u); }) > 0 &&
           sign([](const auto& k) { return (k.u - k.w).dot(k.u); }) > 0;
  }
  const auto s = [](const auto& k) { return k.w.cross(k.v).dot(k.u.cross(k.v)); };
  const auto t = [](const auto& k) { return k.u.cross(k.w).dot(k.u.cross(k.v)); };
  const auto square = [](const auto& k) {
    const auto n = k.u.cross(k.v);
    return n.dot(n);
  };
  if (sign(s) < 0 || sign(t) < 0) return false;
  if (f.triangle) {
    if (sign([&](const auto& k) { return square(k) - s(k) - t(k); }) < 0) return false;
  } else if (sign([&](const auto& k) { return square(k) - s(k); }) < 0 ||
             sign([&](const auto& k) { return square(k) - t(k); }) < 0) {
    return false;
  }
  return sign(square) > 0;
}

/// Whether the line, plane or point that carries the feature is within `radius` of p.
bool carrier_within(const Vec3& p, double radius, const ExactFeature& f) {
  const auto excess = [&](const auto& k) {
    using T = std::decay_t<decltype(k.w.x)>;
    const T square = T::product(radius, radius);
    if (f.dimension == 0) return k.w.dot(k.w) - square;
    if (f.dimension == 1) {
      const auto across = k.w.cross(k.u);
      return across.dot(across) - square * k.u.dot(k.u);
    }
    const auto n = k.u.cross(k.v);
    const T height = k.w.dot(n);
    return height * height - square * n.dot(n);
  };
  return sign_in_frame(p, f, excess) <= 0;
}

/// Vector from the line, plane or point of the feature to p; every coordinate is rounded once from
/// its exact numerator.
Vec3 offset_from(const Vec3& p, const ExactFeature& f) {
  const Frame<Expansion> k(p, f);
  const auto rounded = [](const Triple<Expansion>& v, const Expansion& divisor) {
    return Vec3(Vec3(v.x.estimate(), v.y.estimate(), v.z.estimate()) / divisor.estimate());
  };
  if (f.dimension == 0) return rounded(k.w, Expansion(1.0));
  if (f.dimension == 1) {
    const Expansion square = k.u.dot(k.u);
    return rounded(k.w * square - k.u * k.w.dot(k.u), square);
  }
  const Triple<Expansion> n = k.u.cross(k.v);
  return rounded(n * k.w.dot(n), n.dot(n));
}

ExactFeature corner_of(const Vec3& p) {
  ExactFeature out;
  out.corner[0] = p;
  return out;
}

ExactFeature edge_between(const Vec3& a, const Vec3& b) {
  ExactFeature out = corner_of(a);
  out.dimension = 1;
  out.u = {b, a};
  return out;
}

}  // namespace

std::vector<ExactFeature> features_of(const Segment& s) {
  return {edge_between(s.a, s.b), corner_of(s.a), corner_of(s.b)};
}

std::vector<ExactFeature> features_of(const Triangle3& t) {
  ExactFeature face = edge_between(t[0], t[1]);
  face.dimension = 2;
  face.triangle = true;
  face.v = {t[2], t[0]};
  std::vector<ExactFeature> out{face};
  for (size_t k = 0; k < 3; ++k) out.push_back(edge_between(t[k], t[(k + 1) % 3]));
  for (const Vec3& c : t) out.push_back(corner_of(c));
  return out;
}

std::vector<ExactFeature> features_of(const OrientedBox& box) {
  std::vector<ExactFeature> out;
  const auto arm = [&](int k, int sign) { return Vec3(sign * box.half_axes.col(k)); };
  for (int dimension = 2; dimension >= 0; --dimension) {
    // Each corner starts the features that extend along those axes on which it is at the low end.
    for (int low = 0; low < 8; ++low) {
      for (int along = 0; along < 8; ++along) {
        const int axes = (along & 1) + (along >> 1 & 1) + (along >> 2 & 1);
        if (axes != dimension || (along & ~low) != 0) continue;
        ExactFeature f;
        f.dimension = dimension;
        f.corner[0] = box.centre;
        bool first = true;
        for (int k = 0; k < 3; ++k) {
          f.corner[size_t(k) + 1] = arm(k, low >> k & 1 ? -1 : 1);
          if (!(along >> k & 1)) continue;
          std::array<Vec3, 2>& side = first ? f.u : f.v;
          side = {arm(k, 1), arm(k, -1)};
          first = false;
        }
        out.push_back(f);
      }
    }
  }
  return out;
}

bool within(const Vec3& p, double radius, const std::vector<ExactFeature>& features) {
  for (const ExactFeature& f : features) {
    if (carrier_within(p, radius, f) && projects_into(p, f)) return true;
  }
  return false;
}

Vec3 accurate_offset(const Vec3& p, const std::vector<ExactFeature>& features) {
  Vec3 nearest = Vec3::Zero();
  double square = std::numeric_limits<double>::infinity();
  for (const ExactFeature& f : features) {
    if (!projects_into(p, f)) continue;
    const Vec3 offset = offset_from(p, f);
    if (!(offset.squaredNorm() < square)) continue;
    nearest = offset;
    square = offset.squaredNorm();
  }
  return nearest;
}

}  // namespace tumble
