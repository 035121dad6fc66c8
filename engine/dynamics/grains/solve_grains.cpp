#include "engine/dynamics/grains/solve_grains.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"

namespace tumble {
namespace {

/// Least number of bundles of a colour for which threads are worth their cost.
constexpr size_t least_of_colour = 16;

GrainShift single(const Vec3& x) {
  return {{float(x[0]), float(x[1]), float(x[2])}, 0};
}

void begin_motion(const GrainSystemRows& r, double hs, Crew* crew) {
  const size_t count = r.points.size();
  r.motion.rows.resize(count);
  r.motion.kicks.resize(count);
  r.motion.shifts.resize(count);
  for_chunks(crew, count, [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      const GrainMover& m = r.movers[i];
      const auto inverse_mass = float(r.mass_unit * m.inverse_mass);
      r.motion.rows[i] = {single(m.v).x, inverse_mass, single(m.spin).x,
                          float(r.mass_unit * m.inverse_moment)};
      r.motion.shifts[i] = {{}, inverse_mass};
      r.motion.kicks[i] = single(hs * r.acceleration[i]);
    }
  });
}

/// Takes over the motion of grains with contacts; moves the others, over h seconds.
void end_motion(const GrainSystemRows& r, double h, Crew* crew) {
  const auto wide = [](const std::array<float, 3>& x) {
    return Vec3(double(x[0]), double(x[1]), double(x[2]));
  };
  for_chunks(crew, r.points.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      GrainMover& m = r.movers[i];
      if (r.touched[i]) {
        r.points[i].x += wide(r.motion.shifts[i].x);
        m.v = wide(r.motion.rows[i].v);
        m.spin = wide(r.motion.rows[i].spin);
      } else {
        r.points[i].x += h * (m.v + (0.5 * h) * r.acceleration[i]);
        m.v += h * r.acceleration[i];
      }
    }
  });
}

class SweepGrains {
 public:
  SweepGrains(const GrainSystemRows& rows, double hs, Crew* crew)
      : r_(rows),
        in_{rows.motion.shifts.data(), rows.motion.rows.data(), rows.pairs.all().data(),
            rows.pairs.turnings().empty() ? nullptr : rows.pairs.turnings().data(),
            rows.pairs.bounces().empty() ? nullptr : rows.pairs.bounces().data()},
        walls_{rows.motion.shifts, rows.motion.rows, rows.movers, rows.bodies},
        hs_(hs),
        crew_(crew),
        work_(rows.pairs.blocks() + chunk_count) {}

  /// Contacts between blocks are warm-started first; then each block can be warm-started and swept
  /// at once.
  void substep() {
    const auto rate = float(1 / hs_);
    accelerate();
    with_walls([&](std::span<GrainBodyRow> rows) { warm_start(walls_, rows); });
    between([&](GrainRange range, GrainWork& work) { warm_start_pairs(in_, range, work); });
    blocks([&](size_t, GrainRange range, GrainWork& work) {
      warm_start_pairs(in_, range, work);
      sweep_pairs(in_, range, rate, false, work);
    });
    between([&](GrainRange range, GrainWork& work) { sweep_pairs(in_, range, rate, false, work); });
    with_walls([&](std::span<GrainBodyRow> rows) { sweep(walls_, rows, 1 / hs_); });
    blocks([&](size_t block, GrainRange range, GrainWork&) {
      move(block);
      part_overlapping_pairs(in_, range);
    });
    time_ += hs_;
    between([&](GrainRange range, GrainWork&) { part_overlapping_pairs(in_, range); });
    with_walls([&](std::span<GrainBodyRow> rows) { part_overlapping(walls_, rows, time_); });
    // Contacts have moved with the grains: impulses act at their present places, and the next
    // sub-step begins with the gaps that are left now.
    blocks([&](size_t, GrainRange range, GrainWork& work) {
      sweep_pairs(in_, range, rate, true, work);
    });
    between([&](GrainRange range, GrainWork& work) { sweep_pairs(in_, range, rate, true, work); });
    with_walls([&](std::span<GrainBodyRow> rows) { follow(walls_, rows, time_, 1 / hs_); });
  }
  void bounce() {
    blocks([&](size_t, GrainRange range, GrainWork& work) { bounce_pairs(in_, range, work); });
    between([&](GrainRange range, GrainWork& work) { bounce_pairs(in_, range, work); });
    with_walls([&](std::span<GrainBodyRow> rows) {
      tumble::bounce(walls_, rows, r_.restitution_threshold);
    });
  }
  GrainPairWork work() const {
    GrainPairWork sum;
    for (const GrainWork& w : work_)
      for (size_t lane = 0; lane < grain_lanes; ++lane) {
        sum.lost += r_.mass_unit * w.lost[lane];
        sum.rubbed += r_.mass_unit * w.rubbed[lane];
      }
    return sum;
  }

 private:
  void accelerate() {
    GrainRow* rows = r_.motion.rows.data();
    const GrainShift* kicks = r_.motion.kicks.data();
    for_chunks(crew_, r_.points.size(), [&](size_t, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i)
        for (size_t axis = 0; axis < 3; ++axis) rows[i].v[axis] += kicks[i].x[axis];
    });
  }
  void move(size_t block) {
    const size_t first = block * grain_block,
                 last = std::min(first + grain_block, r_.points.size());
    const auto hs = float(hs_);
    for (size_t i = first; i < last; ++i)
      for (size_t axis = 0; axis < 3; ++axis)
        r_.motion.shifts[i].x[axis] += hs * r_.motion.rows[i].v[axis];
  }
  // Every pass over all contacts checks for a stop; the results of a stopped tick are discarded.
  template <class F>
  void blocks(const F& f) {
    if (stop_requested()) return;
    for_chunks(
        crew_, r_.pairs.blocks(),
        [&](size_t, size_t first, size_t last) {
          for (size_t k = first; k < last; ++k) f(k, r_.pairs.block(k), work_[k]);
        },
        2);
  }
  template <class F>
  void between(const F& f) {
    for (const GrainRange& colour : r_.pairs.between()) {
      if (stop_requested()) return;
      for_chunks(
          crew_, colour.end - colour.begin,
          [&](size_t chunk, size_t first, size_t last) {
            f({uint32_t(colour.begin + first), uint32_t(colour.begin + last)},
              work_[r_.pairs.blocks() + chunk]);
          },
          least_of_colour);
    }
  }
  /// Rows with movable bodies first, one after the other; then the others, in parallel by grain.
  template <class F>
  void with_walls(const F& f) {
    if (stop_requested()) return;
    f(r_.held);
    for_chunks(crew_, r_.walls.size(), [&](size_t, size_t first, size_t last) {
      // Rows of one grain must be in one range.
      const auto start = [&](size_t k) {
        while (k > 0 && k < r_.walls.size() && r_.walls[k].a == r_.walls[k - 1].a) ++k;
        return k;
      };
      const size_t begin = start(first);
      f(r_.walls.subspan(begin, start(last) - begin));
    });
  }

  const GrainSystemRows& r_;
  GrainPairView in_;
  GrainWalls walls_;
  double hs_;
  Crew* crew_;
  std::vector<GrainWork> work_;  ///< by block; then by chunk, for contacts between blocks
  double time_ = 0;              ///< time since the beginning of the part [s]
};

}  // namespace

GrainPairWork solve_grains(const GrainSystemRows& rows, int substeps, double hs, Crew* crew) {
  begin_motion(rows, hs, crew);
  SweepGrains sweeps(rows, hs, crew);
  for (int k = 0; k < substeps && !stop_requested(); ++k) sweeps.substep();
  sweeps.bounce();
  end_motion(rows, substeps * hs, crew);
  return sweeps.work();
}

}  // namespace tumble
