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

/// Which algorithm is to be watched on which bodies, and how.
struct MicroscopeSetup {
  std::string algorithm = "gjk";  ///< name in all_microscopes()
  BodyId a, b;                    ///< null where the algorithm needs none
  ParticleSystemId particles;     ///< null: the first that the algorithm takes
  int step = 0;                   ///< the step that is shown at time 0
  double steps_per_second = 0;    ///< of simulated time
  double span = 1;                ///< how far a motion is looked ahead [s]
  double tolerance = 1e-3;        ///< of a contact [m]
  std::optional<Vec3> beside;     ///< where abstract spaces have their origin [m]; else chosen
  /// Instead of the bodies' own, A's and B's [m/s], [rad/s].
  std::array<std::optional<Vec3>, 2> velocity, angular_velocity;

  /// The step that is due at a time; may be beyond the last.
  int step_at(double time) const;
};

/// One of the two bodies as it is looked at.
struct Specimen {
  std::string name;
  std::shared_ptr<const Shape> shape;
  Motion motion;  ///< of the shape's frame from now, t = 0, to the span

  Pose pose() const { return motion.pose(0); }
};

/// What recorders keep from one slide to the next: what is dear to make and depends on shapes
/// alone. Of one thread.
struct MicroscopeMemory {
  struct Kept {
    std::shared_ptr<const TriangleMesh> of;
    std::string_view kind;
    std::shared_ptr<const void> tree;
  };
  std::vector<Kept> trees;  ///< the newest last
};

/// What lies under the microscope: all that an algorithm's recorder needs.
struct MicroscopeSlide {
  std::array<Specimen, 2> body;
  double tolerance = 1e-3;     ///< [m]
  Vec3 beside = Vec3::Zero();  ///< where abstract spaces are drawn: the place of their origin [m]
  std::shared_ptr<MicroscopeMemory> memory;  ///< no part of what is looked at; null: none is kept

  bool operator==(const MicroscopeSlide& other) const;
};

/// Particles of a system in colours of a step: from the darkest at `low` to the brightest at
/// `high`.
struct ParticleColours {
  ParticleSystemId system;
  std::string title, unit;
  std::vector<float> value;  ///< by particle, in the order of ParticleFrame
  double low = 0, high = 1;
};

/// One step of an algorithm.
struct MicroscopeStep {
  std::string title;    ///< a few words: "V-E: vertex 3 of A, edge 5 of B"
  std::string caption;  ///< what happens and why, for people who see it for the first time
  struct Number {
    std::string label, value;
  };
  std::vector<Number> numbers;
  Sketch sketch;
  Diagram diagram;
  std::optional<ParticleColours> particles;
};

/// An algorithm's way to its answer.
struct MicroscopeRecording {
  std::string title;                  ///< of the algorithm: "GJK"
  std::vector<MicroscopeStep> steps;  ///< never empty
  /// Of the whole: a distance, minus a depth [m], or a time [s]; infinite for "never".
  double answer = 0;
  std::vector<BodyId> see_through;  ///< bodies that hide what is drawn
  double size = 0;                  ///< of what is looked at [m]; 0: that of the two bodies
};

/// An algorithm that works on the shapes of two bodies.
struct PairMicroscope {
  /// Why it cannot look at these two shapes, "" when it can.
  std::string (*refusal)(const Shape& a, const Shape& b);
  MicroscopeRecording (*record)(const MicroscopeSlide& slide);
};

/// An algorithm that works on more than a frame shows: the world is asked, which goes on as if
/// nobody had.
struct WorldMicroscope {
  /// Why there is nothing to ask for, "" when there is.
  std::string (*refusal)(const Frame& frame, const MicroscopeSetup& setup);
  Result<MicroscopeRecording> (*record)(const World& world, const MicroscopeSetup& setup);
};

/// One algorithm that can be watched. One more: its recorder in two files, a line in
/// `CMakeLists.txt` and one in all_microscopes(); scene files, keys, panel and pictures follow.
struct MicroscopeEntry {
  std::string_view name;
  std::string_view doc;
  std::variant<PairMicroscope, WorldMicroscope> way;

  const PairMicroscope* of_pair() const { return std::get_if<PairMicroscope>(&way); }
  const WorldMicroscope* of_world() const { return std::get_if<WorldMicroscope>(&way); }
  /// Of a pair's algorithm alone.
  MicroscopeRecording record(const MicroscopeSlide& slide) const {
    return of_pair()->record(slide);
  }
};
const std::vector<MicroscopeEntry>& all_microscopes();
/// Null for an unknown name.
const MicroscopeEntry* find_microscope(std::string_view name);

/// Why this setup cannot be looked at in this frame, "" when it can: unknown algorithm, a body that
/// is gone or has several shapes, a shape that the algorithm does not take.
std::string microscope_refusal(const Frame& frame, const MicroscopeSetup& setup);

/// What a world said when it was asked.
struct MicroscopeAnswer {
  std::string algorithm;
  uint64_t tick = 0;
  std::optional<MicroscopeRecording> recording;
  std::string refusal;  ///< why there is none
};
/// Null where the algorithm needs nothing but a frame.
std::shared_ptr<const MicroscopeAnswer> ask_world(const World& world, const MicroscopeSetup& setup);

/// The slide of a setup of two bodies that is not refused; `poses` by body slot.
MicroscopeSlide make_slide(const Frame& frame, const std::vector<Pose>& poses,
                           const MicroscopeSetup& setup);

}  // namespace tumble
