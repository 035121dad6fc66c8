#pragma once
#include "tests/geometry/draws.hpp"

#include <string>

/// Families of points that hulls find hard, all of about unit size.
namespace tumble::hull_families {

using Points = std::vector<Vec3>;

struct Family {
  const char* name;
  Points (*draw)(Random& r, uint32_t n, double noise);
};

inline Vec3 noisy(Random& r, double noise) {
  return noise * draws::in_box(r, 1);
}
inline double side(Random& r) {
  return r.below(2) ? 1 : -1;
}
inline Vec3 on_circle(double turn, double z) {
  const double t = 2 * 3.14159265358979323846 * turn;
  return {std::cos(t), std::sin(t), z};
}

template <class Draw>
Points repeat(uint32_t n, const Draw& draw) {
  Points out;
  for (uint32_t i = 0; i < n; ++i) out.push_back(draw());
  return out;
}

inline const std::vector<Family>& all() {
  static const std::vector<Family> families = {
      {"cube surface with noise",
       [](Random& r, uint32_t n, double noise) {
         return repeat(n, [&] {
           Vec3 p = draws::in_box(r, 1);
           p[int(r.below(3))] = side(r) + r.uniform(-noise, noise);
           return p;
         });
       }},
      {"lattice with an ulp of noise",
       [](Random& r, uint32_t n, double) {
         return repeat(n, [&] {
           Vec3 p;
           for (int k = 0; k < 3; ++k) {
             p[k] = 0.1 * double(r.below(8));
             const uint32_t c = r.below(3);
             if (c > 0) p[k] = std::nextafter(p[k], c > 1 ? 10.0 : -10.0);
           }
           return p;
         });
       }},
      {"plane with noise",
       [](Random& r, uint32_t n, double noise) {
         return repeat(n,
                       [&] { return Vec3(draws::in_box(r, 1).cwiseProduct(Vec3(1, 1, noise))); });
       }},
      {"line with noise",
       [](Random& r, uint32_t n, double noise) {
         const Vec3 shape(1, noise, noise * r.uniform(0.1, 10));
         return repeat(n, [&] { return Vec3(draws::in_box(r, 1).cwiseProduct(shape)); });
       }},
      {"sliver",
       [](Random& r, uint32_t n, double) {
         const Vec3 shape(1, std::pow(10.0, r.uniform(-8, 0)), std::pow(10.0, r.uniform(-8, 0)));
         return repeat(n, [&] { return Vec3(draws::in_box(r, 1).cwiseProduct(shape)); });
       }},
      {"caps of a sphere",
       [](Random& r, uint32_t n, double noise) {
         return repeat(n, [&] {
           Vec3 c = noisy(r, 100 * noise);
           c[int(r.below(3))] += side(r);
           return Vec3(c.normalized());
         });
       }},
      {"cylinder",
       [](Random& r, uint32_t n, double noise) {
         const uint32_t m = 3 + r.below(n);
         return repeat(n, [&] {
           return on_circle(double(r.below(m)) / m, side(r) + r.uniform(-noise, noise));
         });
       }},
      {"wedge",
       [](Random& r, uint32_t n, double noise) {
         const double slope = std::pow(10.0, r.uniform(-9, -3));
         return repeat(n, [&] {
           const double x = r.uniform(), y = r.uniform(-1, 1);
           return Vec3(x, y, x * r.uniform(-slope, slope) + r.uniform(-noise, noise) * 0.1);
         });
       }},
      {"tip of a needle",
       [](Random& r, uint32_t n, double) {
         const double slope = std::pow(10.0, r.uniform(-8, -3));
         return repeat(n, [&] {
           const double x = std::pow(10.0, r.uniform(-12, 0));
           return Vec3(x, x * r.uniform(-slope, slope), x * r.uniform(-slope, slope));
         });
       }},
      {"corners repeated with noise",
       [](Random& r, uint32_t n, double noise) {
         return repeat(n, [&] {
           const Vec3 corner(r.below(2), r.below(2), r.below(2));
           return Vec3(corner + noisy(r, noise));
         });
       }},
      {"coordinates of all magnitudes",
       [](Random& r, uint32_t n, double) {
         const auto any = [&] { return side(r) * std::pow(10.0, r.uniform(-320, 0)); };
         Points out = repeat(n, [&] {
           const double x = any(), y = any(), z = any();
           return Vec3(x, y, z);
         });
         out.emplace_back(1, any(), 0);
         return out;
       }},
      {"integer paraboloid",
       [](Random& r, uint32_t n, double) {
         return repeat(n, [&] {
           const double x = double(r.below(41)) - 20, y = double(r.below(41)) - 20;
           return Vec3(x / 20, y / 20, (x * x + y * y) / 800);
         });
       }},
      {"slab of about the tolerance",
       [](Random& r, uint32_t n, double) {
         const double half = std::pow(10.0, r.uniform(-9, -7));
         return repeat(n, [&] {
           const double x = r.uniform(-1, 1), y = r.uniform(-1, 1);
           return Vec3(x, y, side(r) * half + r.uniform(-1e-9, 1e-9));
         });
       }},
  };
  return families;
}

}  // namespace tumble::hull_families
