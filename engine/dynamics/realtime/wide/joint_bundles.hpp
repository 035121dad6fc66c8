#pragma once
#include "engine/dynamics/realtime/solver_rows.hpp"
#include "engine/dynamics/realtime/wide/colouring.hpp"
#include "engine/dynamics/realtime/wide/wide_kernels.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Puts joints of ordinary islands into bundles: ball joints and hinges. All other kinds, joints
/// with arms so long that their rows are linearly dependent in single precision, and those without
/// a free colour are left to the scalar rows. Memory is reused from tick to tick.
class JointBundles {
 public:
  /// Whether a joint goes into bundles, if it finds a colour.
  static bool takes(const Joint& joint, std::span<const RigidBody> bodies);

  void clear();
  /// Adds a joint by its index, between two bodies of the wide island.
  void add(const SolverContext& context, uint32_t source, uint32_t a, uint32_t b);
  /// Colours and bundles the joints that were added; `bodies` is the number of bodies. Returns the
  /// indices of joints without a colour.
  std::span<const uint32_t> bundle(const SolverContext& context, uint32_t bodies);

  size_t size() const { return by_colour_.size(); }
  uint32_t bundles() const { return uint32_t(bundles_.size()); }
  std::span<const WideRange> colours() const { return colours_; }

  /// Sizes the arrays of joints and hinges.
  void resize(WideRows& rows) const;
  /// Fills in bundles for sub-steps of `hs`, after the masses of bodies. Lanes without a joint
  /// connect `fixed` with itself.
  void stage(const SolverContext& context, WideRange bundles, uint32_t fixed, double hs,
             WideRows& rows) const;
  /// Writes the impulses and their sums back to the joints.
  void store(const SolverContext& context, WideRange bundles, double hs,
             const WideRows& rows) const;

 private:
  struct Bundle {
    uint32_t first = 0, lanes = 0;  ///< range of by_colour_
    uint32_t hinge = WideJoint::no_hinge;
  };
  struct Added {
    uint32_t source = 0, a = 0, b = 0;  ///< the joint and its bodies
  };
  void add_bundles(uint32_t first, uint32_t end, bool hinges);
  void stage_bundle(const SolverContext& context, const Bundle& bundle, uint32_t fixed, double hs,
                    std::span<const WideMass> masses, WideJoint& out, WideHinge* hinge) const;

  std::vector<Added> added_;
  std::vector<ColourEdge> edges_;
  Colouring colouring_;
  std::vector<uint32_t> by_colour_;  ///< indices in added_; by kind within a colour
  std::vector<Bundle> bundles_;
  std::vector<WideRange> colours_;
  std::vector<uint32_t> left_over_;
  uint32_t hinges_ = 0;  ///< number of bundles of hinges
};

}  // namespace tumble
