#include "engine/collision/field_pairs/field_pairs.hpp"

#include "engine/collision/feature_key.hpp"
#include "engine/collision/field_pairs/convex_in_field.hpp"
#include "engine/collision/field_pairs/field_corners.hpp"
#include "engine/collision/field_pairs/surface_in_field.hpp"
#include "engine/collision/shapes/polyhedral.hpp"

#include <algorithm>

namespace tumble {
namespace {

PlacedSurface placed(const Shape& shape, const Pose& pose) {
  return {shape.polyhedral()->surface(), pose.q.toRotationMatrix(), pose.x};
}

PlacedSurface at_home(const Shape& shape) {
  return placed(shape, Pose{});
}

/// Contacts during the search, in the frame of one of the two shapes.
class Found {
 public:
  explicit Found(std::vector<FeatureContact>& contacts) : contacts_(contacts) { contacts.clear(); }

  /// Transforms the contacts added since the last call from the frame of a shape at `frame` to that
  /// of the pair. `of_b`: their normals point out of B, not of A; `side` distinguishes the keys of
  /// the two searches.
  void turn(const Pose& frame, bool of_b, uint64_t side) {
    const Mat3 R = frame.q.toRotationMatrix();
    for (; done_ < contacts_.size(); ++done_) {
      FeatureContact& c = contacts_[done_];
      c.x = frame.x + R * c.x;
      c.normal = of_b ? Vec3(-(R * c.normal)) : Vec3(R * c.normal);
      c.key = mix_key(c.key, side);
    }
  }
  void emit(const ShapePair& pair, std::vector<Manifold>& out) {
    if (contacts_.size() > tolerances::most_contacts) {
      const auto deeper = [](const FeatureContact& a, const FeatureContact& b) {
        return a.gap != b.gap ? a.gap < b.gap : a.key < b.key;
      };
      std::ranges::nth_element(contacts_, contacts_.begin() + tolerances::most_contacts, deeper);
      contacts_.resize(tolerances::most_contacts);
    }
    emit_patches(pair, contacts_, out);
  }

 private:
  std::vector<FeatureContact>& contacts_;
  size_t done_ = 0;
};

std::vector<FeatureContact>& memory() {
  thread_local std::vector<FeatureContact> contacts;
  return contacts;
}

/// Whether the distance exceeds the margin, which is then reported to the pair.
bool apart(const ShapePair& pair, double distance) {
  if (distance <= pair.margin) return false;
  pair.found_apart(distance, pair.pose_b.x.cwiseAbs().sum() + pair.a.bounding_radius() +
                                 pair.b.bounding_radius());
  return true;
}

}  // namespace

void collide_convex_field(const ShapePair& pair, std::vector<Manifold>& out) {
  const ConvexShape& a = *pair.a.convex();
  const DistanceField& field = *pair.b.field();
  const Pose a_in_b = pair.pose_b.inverse() * pair.pose_a;
  std::vector<FeatureContact>& contacts = memory();
  Found found(contacts);
  const double distance = a.polyhedral()
                              ? surface_in_field(placed(a, a_in_b), field, pair.margin,
                                                 FieldSearch::corners_and_edges, contacts)
                              : convex_in_field(a, a_in_b, field, pair.margin, contacts);
  if (apart(pair, distance)) return;
  found.turn(pair.pose_b, true, 0);
  if (!a.is_ball()) {  // which has no face that a corner may touch elsewhere
    corners_in_convex(at_home(pair.b), a, a_in_b, pair.margin, contacts);
    found.turn(pair.pose_b, false, 1);
  }
  found.emit(pair, out);
}

void collide_mesh_field(const ShapePair& pair, std::vector<Manifold>& out) {
  const Pose a_in_b = pair.pose_b.inverse() * pair.pose_a;
  const PlacedSurface a = placed(pair.a, a_in_b);
  std::vector<FeatureContact>& contacts = memory();
  Found found(contacts);
  const double distance =
      surface_in_field(a, *pair.b.field(), pair.margin, FieldSearch::corners_and_edges, contacts);
  if (apart(pair, distance)) return;
  found.turn(pair.pose_b, true, 0);
  corners_on_mesh(at_home(pair.b), a, pair.margin, contacts);
  found.turn(pair.pose_b, false, 1);
  found.emit(pair, out);
}

void collide_field_field(const ShapePair& pair, std::vector<Manifold>& out) {
  const Pose a_in_b = pair.pose_b.inverse() * pair.pose_a;
  std::vector<FeatureContact>& contacts = memory();
  Found found(contacts);
  const double distance = surface_in_field(placed(pair.a, a_in_b), *pair.b.field(), pair.margin,
                                           FieldSearch::corners_and_edges, contacts);
  if (apart(pair, distance)) return;
  found.turn(pair.pose_b, true, 0);
  surface_in_field(placed(pair.b, a_in_b.inverse()), *pair.a.field(), pair.margin,
                   FieldSearch::corners_and_edges, contacts);
  found.turn(pair.pose_a, false, 1);
  found.emit(pair, out);
}

}  // namespace tumble
