#pragma once
#include "engine/collision/motion.hpp"
#include "engine/collision/shape.hpp"
#include "engine/core/result.hpp"
#include "engine/world/frame.hpp"
#include "engine/world/microscope/sketch.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

class World;

/// Which algorithm is shown on which bodies, and how.
struct MicroscopeSetup {
  std::string algorithm = "gjk";  ///< name in all_microscopes()
  BodyId a, b;                    ///< null where the algorithm needs none
  ParticleSystemId particles;     ///< null: the first system that the algorithm accepts
  int step = 0;                   ///< the step that is shown at time 0
  double steps_per_second = 0;    ///< of simulated time
  double span = 1;                ///< how far ahead motions are computed [s]
  double tolerance = 1e-3;        ///< distance that counts as contact [m]
  /// World position of the origin of abstract spaces [m]; else chosen.
  std::optional<Vec3> beside;
  /// Velocities of A and B to use instead of their own [m/s], [rad/s].
  std::array<std::optional<Vec3>, 2> velocity, angular_velocity;

  /// The step that is shown at a time; may be beyond the last.
  int step_at(double time) const;
};

/// One of the two bodies, as the algorithm is given it.
struct Specimen {
  std::string name;
  std::shared_ptr<const Shape> shape;
  Motion motion;  ///< of the shape's frame from now, t = 0, to the end of the span

  Pose pose() const { return motion.pose(0); }
};

/// What recorders keep from one slide to the next: data that is expensive to build and depends on
/// the shapes alone. For use by one thread.
struct MicroscopeMemory {
  struct Kept {
    std::shared_ptr<const TriangleMesh> of;
    std::string_view kind;
    std::shared_ptr<const void> tree;
  };
  std::vector<Kept> trees;  ///< the newest last
};

/// All that a recorder of a pair is given.
struct MicroscopeSlide {
  std::array<Specimen, 2> body;
  double tolerance = 1e-3;     ///< [m]
  Vec3 beside = Vec3::Zero();  ///< world position of the origin of abstract spaces [m]
  std::shared_ptr<MicroscopeMemory> memory;  ///< not compared by ==; null: nothing is kept

  bool operator==(const MicroscopeSlide& other) const;
};

/// Colours of the particles of a system in a step: from darkest at `low` to brightest at `high`.
struct ParticleColours {
  ParticleSystemId system;
  std::string title, unit;
  std::vector<float> value;  ///< by particle, in the order of ParticleFrame
  double low = 0, high = 1;
};

/// One step of an algorithm.
struct MicroscopeStep {
  std::string title;  ///< a few words: "V-E: vertex 3 of A, edge 5 of B"
  /// What happens and why, for people who see the algorithm for the first time.
  std::string caption;
  struct Number {
    std::string label, value;
  };
  std::vector<Number> numbers;
  Sketch sketch;
  Diagram diagram;
  std::optional<ParticleColours> particles;
};

/// All steps of an algorithm up to its answer.
struct MicroscopeRecording {
  std::string title;                  ///< of the algorithm: "GJK"
  std::vector<MicroscopeStep> steps;  ///< never empty
  /// The result: a distance or minus a depth [m], or a time [s]; infinite for "never".
  double answer = 0;
  std::vector<BodyId> see_through;  ///< bodies to be drawn transparent, as they hide what is drawn
  double size = 0;                  ///< extent of what is shown [m]; 0: that of the two bodies
};

/// An algorithm that works on the shapes of two bodies.
struct PairMicroscope {
  /// Why it cannot look at these two shapes, "" when it can.
  std::string (*refusal)(const Shape& a, const Shape& b);
  MicroscopeRecording (*record)(const MicroscopeSlide& slide);
};

/// An algorithm that needs more than a frame contains: it is recorded from the world itself, whose
/// state is not changed.
struct WorldMicroscope {
  /// Why there is nothing to record, "" when there is.
  std::string (*refusal)(const Frame& frame, const MicroscopeSetup& setup);
  Result<MicroscopeRecording> (*record)(const World& world, const MicroscopeSetup& setup);
};

/// An algorithm that can be watched. To add one: its recorder in two files, a line in
/// `CMakeLists.txt` and one in all_microscopes(); scene files, keys, panel and pictures follow.
struct MicroscopeEntry {
  std::string_view name;
  std::string_view doc;
  std::variant<PairMicroscope, WorldMicroscope> way;

  const PairMicroscope* of_pair() const { return std::get_if<PairMicroscope>(&way); }
  const WorldMicroscope* of_world() const { return std::get_if<WorldMicroscope>(&way); }
  /// Only for an algorithm on a pair.
  MicroscopeRecording record(const MicroscopeSlide& slide) const {
    return of_pair()->record(slide);
  }
};
const std::vector<MicroscopeEntry>& all_microscopes();
/// Null for an unknown name.
const MicroscopeEntry* find_microscope(std::string_view name);

/// Why this setup cannot be shown in this frame, "" when it can: unknown algorithm, a body that
/// does not exist or has several shapes, a shape that the algorithm does not accept.
std::string microscope_refusal(const Frame& frame, const MicroscopeSetup& setup);

/// The answer of a world to a request for a recording.
struct MicroscopeAnswer {
  std::string algorithm;
  uint64_t tick = 0;
  std::optional<MicroscopeRecording> recording;
  std::string refusal;  ///< why there is none
};
/// Null if the algorithm needs no more than a frame.
std::shared_ptr<const MicroscopeAnswer> ask_world(const World& world, const MicroscopeSetup& setup);

/// The slide of a setup of two bodies that is not refused; `poses` is by body slot.
MicroscopeSlide make_slide(const Frame& frame, const std::vector<Pose>& poses,
                           const MicroscopeSetup& setup);

}  // namespace tumble
