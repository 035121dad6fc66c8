#pragma once
#include "engine/world/frame.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

class World;
struct BuiltScene;

/// CSV with one row per tick: time, energies, momenta, contacts, the contribution of every cause
/// since the start (work, and the change of energy by it), readings of sensors, coordinates and
/// reactions of joints, count, speed and temperature of particle systems under the names of
/// quantity(), and the wall time of each stage. If there are more than `most_joints` joints, the
/// others are left out; JointCsv has a row for each. The columns are fixed at the first step:
/// stages that appear later are left out, and so are forces without a name.
class EnergyCsv {
 public:
  static constexpr size_t most_joints = 100;
  EnergyCsv(const std::filesystem::path& file, std::shared_ptr<const BuiltScene> names);
  void add(const Frame& frame);
  Status commit();
  Status status() const { return file_.status(); }

 private:
  void write_header(const Frame& frame);
  void write_row(const Frame& frame);
  std::string ledger_columns() const;
  std::string ledger_values(const Ledger& ledger) const;
  FileWriter file_;
  std::vector<std::pair<ForceId, std::string>> force_names_;
  std::shared_ptr<const Frame> first_;
  std::vector<std::string> stages_;
  std::vector<SensorId> sensors_;
  std::shared_ptr<const BuiltScene> names_;
  std::vector<std::string> named_;  ///< names for quantity()
  bool header_ = false;
  std::string start_row_;
};

/// CSV with one row per contact and tick: bodies, position, normal, gap, impulse and force.
class ContactCsv {
 public:
  explicit ContactCsv(const std::filesystem::path& file);
  void add(const Frame& frame);
  Status commit() { return file_.commit(); }
  Status status() const { return file_.status(); }

 private:
  FileWriter file_;
};

/// CSV with one row per joint and tick, the start included: the reaction on B at that moment, with
/// its torque about B's anchor, and the means over the tick before it.
class JointCsv {
 public:
  explicit JointCsv(const std::filesystem::path& file);
  /// Error: the reactions could not be computed.
  Status add(const World& world);
  Status commit() { return file_.commit(); }
  Status status() const { return file_.status(); }

 private:
  FileWriter file_;
};

/// The stages of every step in the format of Chrome traces (chrome://tracing, Perfetto).
class StageTrace {
 public:
  explicit StageTrace(const std::filesystem::path& file);
  /// Adds a step. `begin_seconds`: its start after that of the first one.
  void add(uint64_t tick, const StageTimes& stages, double begin_seconds, double seconds);
  Status commit();
  Status status() const { return file_.status(); }

 private:
  void event(std::string_view name, double begin_seconds, double seconds, uint64_t tick);
  FileWriter file_;
  bool any_ = false;
};

}  // namespace tumble
