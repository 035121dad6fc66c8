#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/math/det/det.hpp"

#include <cmath>

namespace tumble {
namespace {

Mat3 diagonal(double x, double y, double z) {
  return Vec3(x, y, z).asDiagonal();
}

/// d|^2 1 - d d^T, for the parallel axis theorem.
Mat3 steiner(const Vec3& d) {
  return d.squaredNorm() * Mat3::Identity() - d * d.transpose();
}

}  // namespace

MassProperties sphere_mass(double radius, double density) {
  const double m = density * 4.0 / 3.0 * det::pi * radius * radius * radius;
  const double i = 0.4 * m * radius * radius;
  return {m, Vec3::Zero(), diagonal(i, i, i)};
}

MassProperties box_mass(const Vec3& half_extents, double density) {
  const Vec3 s = half_extents.cwiseProduct(half_extents);
  const double m = density * 8 * half_extents.x() * half_extents.y() * half_extents.z();
  return {m, Vec3::Zero(),
          diagonal(m / 3 * (s.y() + s.z()), m / 3 * (s.z() + s.x()), m / 3 * (s.x() + s.y()))};
}

MassProperties cylinder_mass(double half_height, double radius, double density) {
  const double r2 = radius * radius, h2 = half_height * half_height;
  const double m = density * det::pi * r2 * 2 * half_height;
  const double across = m * (r2 / 4 + h2 / 3);
  return {m, Vec3::Zero(), diagonal(across, 0.5 * m * r2, across)};
}

MassProperties capsule_mass(double half_height, double radius, double density) {
  const double r2 = radius * radius, h = half_height;
  const MassProperties middle = cylinder_mass(half_height, radius, density);
  const double ball = density * 4.0 / 3.0 * det::pi * r2 * radius;  // mass of both half balls
  // The centre of mass of a half ball is 3r/8 from its flat face; its transverse inertia about the
  // centre of that face is that of the ball, 2/5 m r^2. Moved by h along the axis: I = 2/5 m r^2 +
  // m h^2 + 2 m h 3r/8.
  const double along = 0.4 * ball * r2;
  const double across = along + ball * (h * h + 0.75 * h * radius);
  return {middle.mass + ball, Vec3::Zero(), middle.inertia + diagonal(across, along, across)};
}

MassProperties cone_mass(double half_height, double radius, double density) {
  const double r2 = radius * radius, h = 2 * half_height;
  const double m = density * det::pi * r2 * h / 3;
  const double across = 3.0 / 80 * m * (4 * r2 + h * h);
  return {m, Vec3(0, -0.5 * half_height, 0), diagonal(across, 0.3 * m * r2, across)};
}

MassProperties ellipsoid_mass(const Vec3& radii, double density) {
  const Vec3 s = radii.cwiseProduct(radii);
  const double m = density * 4.0 / 3.0 * det::pi * radii.x() * radii.y() * radii.z();
  return {m, Vec3::Zero(),
          diagonal(m / 5 * (s.y() + s.z()), m / 5 * (s.z() + s.x()), m / 5 * (s.x() + s.y()))};
}

MassProperties torus_mass(double major, double minor, double density) {
  const double a2 = minor * minor, c2 = major * major;
  const double m = density * 2 * det::pi * det::pi * major * a2;
  const double across = m * (0.5 * c2 + 0.625 * a2);
  return {m, Vec3::Zero(), diagonal(across, m * (c2 + 0.75 * a2), across)};
}

MassProperties tetrahedron_mass(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                                double density) {
  const Vec3 u = b - a, v = c - a, w = d - a, middle = (u + v + w) / 4;
  const double m = density * std::fabs(u.dot(v.cross(w))) / 6;
  // About the centre, the integral of x x^T is m / 20 times the sum over the corners.
  Mat3 second = middle * middle.transpose();
  for (const Vec3& p : {u, v, w}) second += (p - middle) * (p - middle).transpose();
  second *= m / 20;
  return {m, a + middle, second.trace() * Mat3::Identity() - second};
}

MassProperties moved(const MassProperties& m, const Pose& pose) {
  const Mat3 r = pose.q.toRotationMatrix();
  const Mat3 turned = r * m.inertia * r.transpose();
  return {m.mass, pose.point(m.centre), 0.5 * (turned + turned.transpose())};
}

MassProperties compound(std::span<const MassProperties> parts) {
  MassProperties out;
  Vec3 moment = Vec3::Zero();
  if (parts.empty()) return out;
  const Vec3 origin = parts.front().centre;  // local, for accuracy far from the origin of the frame
  for (const MassProperties& p : parts) {
    out.mass += p.mass;
    moment += p.mass * (p.centre - origin);
  }
  if (!(out.mass > 0)) return {};
  out.centre = origin + moment / out.mass;
  for (const MassProperties& p : parts) {
    out.inertia += p.inertia + p.mass * steiner(p.centre - out.centre);
  }
  return out;
}

Mat3 inertia_about(const MassProperties& m, const Vec3& point) {
  return m.inertia + m.mass * steiner(point - m.centre);
}

}  // namespace tumble
