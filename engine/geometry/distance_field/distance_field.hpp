#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/result.hpp"
#include "engine/geometry/distance_field/field_layout.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <optional>
#include <vector>

namespace tumble {

class Crew;

/// Must be changed whenever the same mesh and options may give another field than before: caches of
/// fields are keyed by it.
inline constexpr uint32_t field_version = 2;

struct DistanceFieldOptions {
  /// Side of a cell [m]; 0: follows from `error`, or, if that is 0 too, a 64th of the mesh's
  /// longest side.
  double cell = 0;
  /// Bound of the error in the band [m]; 0: none. If `cell` is given they must agree.
  double error = 0;
  double band = 2;                     ///< half width of the narrow band of fine cells [cells]
  size_t max_bytes = size_t{1} << 30;  ///< limit of the field's memory; an error if exceeded
  Crew* crew = nullptr;                ///< the field is the same, bit by bit, with any or none
};

/// The side of the cells that the options imply for a mesh with these bounds [m].
double field_cell(const DistanceFieldOptions& options, const Aabb& bounds);
/// Bound of the interpolation error in a band with such cells [m].
double field_error(double cell);

/// The part of a field that a sample comes from.
enum class FieldLevel : uint8_t {
  band,     ///< the fine cells near the surface
  coarse,   ///< the corners of the blocks, improved by fine nodes nearby
  outside,  ///< beyond the field's box
};

/// The field at a point.
struct DistanceSample {
  double distance = 0;           ///< signed, negative inside [m]
  Vec3 gradient = Vec3::Zero();  ///< of the interpolant; of length 1 up to the error
  double error = 0;              ///< upper bound of |distance - exact| [m]
  FieldLevel level = FieldLevel::band;
};

/// Nearest point of the surface, estimated by the field alone.
struct FieldFoot {
  Vec3 point = Vec3::Zero();
  double residual = 0;  ///< |distance| of the field at `point` [m]
};

/// What a field consists of.
struct FieldReport {
  size_t blocks = 0;          ///< blocks with fine nodes
  size_t bytes = 0;           ///< all of the field
  double bytes_per_area = 0;  ///< of the mesh's surface [bytes/m^2]
  int bits = 16;              ///< of the value at a node
  double node_error = 0;      ///< largest error of a stored value [m]
  double band_error = 0;      ///< largest error of any point in the band [m]
  size_t nodes = 0;           ///< number of nodes whose sign was computed
  /// Nodes with a winding number above one, or with a parity of crossings that disagrees with it:
  /// parts of the mesh overlap there. Their sign is that of the union; their distance, as
  /// everywhere, is that from the nearest triangle, which may be inside the union.
  size_t overlapped_nodes = 0;
};

/// Signed distance from a closed triangle mesh (Coutinho 2013 §12): negative where the winding
/// number of the surface is not zero. Blocks of fine cells cover only a narrow band about the
/// surface; the corners of all blocks form a coarse level.
///
/// At fine nodes within node_range() of the surface, distances are exact up to the rounding of
/// storage (FieldReport::node_error). Between nodes they are interpolated trilinearly; since a
/// distance function has Lipschitz constant 1, the error is at most sqrt(3)/2 cells, and of second
/// order where the surface is smooth. This holds for every point within band() of the surface.
/// Beyond it the coarse level is used, clamped to what the nodes nearby allow;
/// DistanceSample::error bounds its error. For more accuracy there, call exact_distance().
///
/// Queries are const and may run in many threads at once.
class DistanceField {
 public:
  /// The best estimate at a point [m].
  double value(const Vec3& p) const;
  /// The same, with the gradient.
  double value(const Vec3& p, Vec3& gradient) const;
  /// The same, with its error bound and level.
  DistanceSample sample(const Vec3& p) const;
  /// Follows the gradient to the surface. Exact where the field is that of a plane; for a point far
  /// away, or with several nearest points, it is some near point of the surface, but perhaps not
  /// the nearest: use exact_distance() for closest points that must be right.
  FieldFoot foot(const Vec3& p) const;

  const FieldLayout& layout() const { return layout_; }
  double cell() const { return layout_.cell; }
  double band() const { return band_; }              ///< [m]
  double node_range() const { return node_range_; }  ///< [m]
  const FieldReport& report() const { return report_; }
  /// Hash of everything stored, to compare two fields.
  uint64_t hash() const;
  /// As bytes, and back; the reader returns nothing for bytes that are not a field.
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
  std::vector<uint32_t> block_of_;  ///< by position: index of the block, or no_index
  std::vector<int16_t> short_values_;
  std::vector<int32_t> long_values_;  ///< used instead if 16 bits are too few
  std::vector<float> corners_;        ///< distance at the corners of all blocks [m]
  FieldReport report_;
};

/// Builds the field of a hierarchy's mesh. Signs are computed by scan lines: the crossings of rows
/// of nodes with the surface, decided exactly (ray_crossing), give the winding number of every
/// node. Magnitudes in the band are computed for each node from the triangles near its block.
/// Errors: the mesh is not closed and consistently oriented, or is empty; options out of range; the
/// field would be too large (the cure names a cell that fits); cancelled (engine/core/stop.hpp).
Result<DistanceField> make_distance_field(const Hierarchy& surface,
                                          const DistanceFieldOptions& options = {});

/// Exact signed distance, up to rounding.
struct ExactDistance {
  double distance = 0;           ///< negative inside [m]
  Vec3 closest = Vec3::Zero();   ///< on the surface
  Vec3 gradient = Vec3::Zero();  ///< unit; on the surface itself the face's normal
  uint32_t triangle = no_index;
};
/// By the hierarchy of a closed mesh with triangles; the sign is that of point_in_object().
ExactDistance exact_distance(const Hierarchy& surface, const Vec3& p);

/// Error of a field, measured against exact_distance().
struct FieldError {
  double rms = 0, largest = 0;  ///< [m]
  size_t samples = 0;
};
/// Measured at points of a low-discrepancy sequence (Halton 1960) that are within the band.
FieldError measure_field_error(const DistanceField& field, const Hierarchy& surface,
                               size_t samples);

}  // namespace tumble
