#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/result.hpp"
#include "engine/geometry/distance_field/field_layout.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <optional>
#include <vector>

namespace tumble {

class Crew;

/// Changes whenever the same mesh and options may give another field than before: what is kept of
/// fields is kept by it.
inline constexpr uint32_t field_version = 1;

struct DistanceFieldOptions {
  /// Side of a cell [m]; 0: what `error` asks for, or, when that is 0 too, a 64th of the mesh's
  /// longest side.
  double cell = 0;
  /// No point of the band errs by more [m]; 0: no wish. With `cell` given it must agree.
  double error = 0;
  double band = 2;                     ///< how near the surface answers are the fine ones [cells]
  size_t max_bytes = size_t{1} << 30;  ///< of the field; more is an error
  Crew* crew = nullptr;                ///< the field is the same, bit by bit, with any or none
};

/// The side of the cells that options ask for of a mesh with these bounds [m].
double field_cell(const DistanceFieldOptions& options, const Aabb& bounds);
/// How far any point of the band of such cells may err at most, between the nodes [m].
double field_error(double cell);

/// Which part of a field answered.
enum class FieldLevel : uint8_t {
  band,     ///< the fine cells about the surface
  coarse,   ///< the corners of the blocks, and what fine nodes say nearby
  outside,  ///< beyond the field's box
};

/// The field at a point.
struct DistanceSample {
  double distance = 0;           ///< signed, negative inside [m]
  Vec3 gradient = Vec3::Zero();  ///< of what is interpolated there; its length is 1 up to the error
  double error = 0;              ///< |distance - exact| is no more [m]
  FieldLevel level = FieldLevel::band;
};

/// Where the surface is nearest, by the field alone.
struct FieldFoot {
  Vec3 point = Vec3::Zero();
  double residual = 0;  ///< |distance| of the field at `point` [m]
};

/// What a field consists of.
struct FieldReport {
  size_t blocks = 0;          ///< that hold fine nodes
  size_t bytes = 0;           ///< all of the field
  double bytes_per_area = 0;  ///< of the mesh's surface [bytes/m^2]
  int bits = 16;              ///< of the value at a node
  double node_error = 0;      ///< of a stored value at most [m]
  double band_error = 0;      ///< of any point in the band at most [m]
  size_t nodes = 0;           ///< whose side was decided
  /// Nodes about which the surface winds more than once, or where parity of crossings and winding
  /// number disagree: parts of the mesh overlap there. Their sign is that of the union; their
  /// distance, as everywhere, that of the nearest triangle, which may lie inside the union.
  size_t overlapped_nodes = 0;
};

/// Signed distance from a closed triangle mesh (Coutinho 2013 §12): negative where the surface
/// winds around a point. Fine cells stand in blocks in a narrow band about the surface only; block
/// corners everywhere make a coarse level.
///
/// At fine nodes that are no further than node_range() from the surface distances are exact up to
/// the rounding of storage (FieldReport::node_error). Between nodes they are trilinear, which, as a
/// distance changes by no more than one goes, errs by no more than sqrt(3)/2 cells and, where the
/// surface is smooth, of second order. Every point within band() of the surface has such an answer.
/// What is farther comes from the coarse level, held within what the nodes about it allow;
/// DistanceSample::error bounds it. Whoever needs more there asks exact_distance().
///
/// Queries are const and may run in many threads at once.
class DistanceField {
 public:
  /// Best value at a point [m].
  double value(const Vec3& p) const;
  /// The same, with the gradient.
  double value(const Vec3& p, Vec3& gradient) const;
  /// The same, with its bound of error and where it is from.
  DistanceSample sample(const Vec3& p) const;
  /// Walks along the gradient to the surface. Exact where the field is that of a plane; at a point
  /// far away, or whose nearest points are several, it is one near point of the surface and perhaps
  /// not the nearest: closest points that must be right come from exact_distance().
  FieldFoot foot(const Vec3& p) const;

  const FieldLayout& layout() const { return layout_; }
  double cell() const { return layout_.cell; }
  double band() const { return band_; }              ///< [m]
  double node_range() const { return node_range_; }  ///< [m]
  const FieldReport& report() const { return report_; }
  /// All that is stored, to compare two fields.
  uint64_t hash() const;
  /// As bytes, and back: nothing where they are not those of a field.
  void write(ByteWriter& out) const;
  static std::optional<DistanceField> read(ByteReader& in);

 private:
  friend class DistanceFieldBuilder;
  struct FineCell;
  bool find_cell(const Vec3& p, FineCell& out) const;
  template <class Stored>
  bool read_corners(const std::vector<Stored>& values, const FineCell& cell,
                    std::array<double, 8>& out) const;
  bool corners_of(const FineCell& cell, std::array<double, 8>& out) const;
  DistanceSample far_sample(const Vec3& p) const;
  DistanceSample coarse_sample(const Vec3& p) const;

  FieldLayout layout_;
  double inverse_cell_ = 1;
  double band_ = 0, node_range_ = 0, step_ = 1;
  Aabb mesh_box_;
  std::vector<uint32_t> block_of_;  ///< of each place, the number of the block or no_index
  std::vector<int16_t> short_values_;
  std::vector<int32_t> long_values_;  ///< instead, where 16 bits are too few
  std::vector<float> corners_;        ///< distance at the corners of all blocks [m]
  FieldReport report_;
};

/// Builds the field of a hierarchy's mesh. Signs by scan lines: crossings of rows of nodes with the
/// surface, decided exactly (ray_crossing), give the winding number of every node. Magnitudes in
/// the band by measuring each node against the triangles near its block. Errors: the mesh is not
/// closed and consistently oriented, or is empty; options out of range; the field would be too
/// large (the cure names a cell that fits); cancelled (engine/core/stop.hpp).
Result<DistanceField> make_distance_field(const Hierarchy& surface,
                                          const DistanceFieldOptions& options = {});

/// Exact signed distance, to rounding.
struct ExactDistance {
  double distance = 0;           ///< negative inside [m]
  Vec3 closest = Vec3::Zero();   ///< on the surface
  Vec3 gradient = Vec3::Zero();  ///< unit; on the surface itself the face's normal
  uint32_t triangle = no_index;
};
/// By the hierarchy of a closed mesh with triangles; the sign is that of point_in_object().
ExactDistance exact_distance(const Hierarchy& surface, const Vec3& p);

/// How far a field is off, measured against exact_distance().
struct FieldError {
  double rms = 0, largest = 0;  ///< [m]
  size_t samples = 0;
};
/// At points of a low-discrepancy sequence (Halton 1960) that lie within the band.
FieldError measure_field_error(const DistanceField& field, const Hierarchy& surface,
                               size_t samples);

}  // namespace tumble
