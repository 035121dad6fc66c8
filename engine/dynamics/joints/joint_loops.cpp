#include "engine/dynamics/joints/joint_loops.hpp"

#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>
#include <array>

namespace tumble {
namespace {

/// The joints of a graph that is left when bodies with a single joint are taken away with it, again
/// and again. Its nodes are the movable bodies, and one for all that cannot move.
class LoopFinder {
 public:
  LoopFinder(std::span<const Joint> joints, std::span<const uint32_t> which,
             std::span<const RigidBody> bodies)
      : joints_(joints), bodies_(bodies), at_(bodies.size()), left_(joints.size(), false) {
    for (const uint32_t j : which) {
      const auto [a, b] = std::array{joints[j].a, joints[j].b};
      if (!moves(a) && !moves(b)) continue;
      left_[j] = true;
      for (const uint32_t slot : {a, b})
        if (moves(slot)) at_[slot].push_back(j);
    }
    strip();
  }
  bool moves(uint32_t slot) const { return slot != no_body && bodies_[slot].dynamic(); }
  bool left(uint32_t joint) const { return left_[joint]; }

 private:
  void strip() {
    std::vector<uint32_t> ends;
    for (uint32_t slot = 0; slot < at_.size(); ++slot)
      if (at_[slot].size() == 1) ends.push_back(slot);
    while (!ends.empty()) {
      const uint32_t slot = ends.back();
      ends.pop_back();
      if (at_[slot].size() != 1) continue;  // its neighbour was taken away with the same joint
      const uint32_t j = at_[slot].front();
      left_[j] = false;
      for (const uint32_t end : {joints_[j].a, joints_[j].b}) {
        if (!moves(end)) continue;
        std::erase(at_[end], j);
        if (at_[end].size() == 1) ends.push_back(end);
      }
    }
  }

  std::span<const Joint> joints_;
  std::span<const RigidBody> bodies_;
  std::vector<std::vector<uint32_t>> at_;  ///< by body: joints that are left
  std::vector<bool> left_;                 ///< by joint
};

/// The share of a row in a wrench on B; the rows of a joint are orthogonal where it holds.
double share_of(const JointRow& row, const Vec3& arm_b, const JointWrench& wrench) {
  const double unit = 1;
  const JointWrench of_row = joint_wrench({&row, 1}, {&unit, 1}, arm_b);
  const double size = of_row.force.squaredNorm() + of_row.torque.squaredNorm();
  return size > 0 ? (of_row.force.dot(wrench.force) + of_row.torque.dot(wrench.torque)) / size : 0;
}

}  // namespace

std::vector<JointLoops> find_loops(std::span<const Joint> joints, std::span<const uint32_t> which,
                                   std::span<const RigidBody> bodies) {
  const LoopFinder finder(joints, which, bodies);
  DisjointSets sets(bodies.size());
  for (const uint32_t j : which)
    if (finder.left(j) && finder.moves(joints[j].a) && finder.moves(joints[j].b))
      sets.join(joints[j].a, joints[j].b);
  std::vector<JointLoops> out;
  std::vector<uint32_t> place(bodies.size(), no_block);  // by root
  for (const uint32_t j : which) {
    if (!finder.left(j)) continue;
    const uint32_t root = sets.root(finder.moves(joints[j].a) ? joints[j].a : joints[j].b);
    if (place[root] == no_block) {
      place[root] = uint32_t(out.size());
      out.emplace_back();
    }
    JointLoops& loops = out[place[root]];
    loops.joints.push_back(j);
    for (const uint32_t slot : {joints[j].a, joints[j].b})
      if (finder.moves(slot)) loops.bodies.push_back(slot);
  }
  std::erase_if(out, [&](const JointLoops& loops) {
    size_t rows = 0;
    for (const uint32_t j : loops.joints) rows += row_count(joints[j].kind);
    return rows > tolerances::most_shared_rows;
  });
  std::vector<uint32_t> block_of(bodies.size(), no_block);
  for (JointLoops& loops : out) {
    std::ranges::sort(loops.bodies);
    loops.bodies.erase(std::unique(loops.bodies.begin(), loops.bodies.end()), loops.bodies.end());
    for (uint32_t i = 0; i < loops.bodies.size(); ++i) block_of[loops.bodies[i]] = i;
    loops.rows = Articulation({joints}, {loops.joints}, block_of, bodies, loops.bodies.size(),
                              Articulation::Drives::none);
    for (const uint32_t slot : loops.bodies) block_of[slot] = no_block;
  }
  return out;
}

void share_impulses(JointLoops& loops, std::span<const RigidBody> bodies, std::span<Joint> joints) {
  Articulation& rows = loops.rows;
  rows.look(bodies);
  loops.blocks.assign(loops.bodies.size(), {});
  put_masses(bodies, loops.bodies, loops.blocks);
  std::vector<double>&given = loops.given, &change = loops.change;
  std::vector<Vec3>& arms = loops.arms;
  given.resize(rows.size());
  arms.clear();
  for (size_t k = 0; k < loops.joints.size(); ++k) {
    const Joint& joint = joints[loops.joints[k]];
    arms.push_back(joint_sides(joint, bodies).b.arm);
    for (size_t r = rows.first_row(k); r < rows.first_row(k + 1); ++r)
      given[r] = share_of(rows.rows()[r], arms[k], joint.impulse);
  }
  change = given;
  loops.least.spread(rows, loops.blocks, typical_arm(bodies, loops.bodies), change);
  for (size_t r = 0; r < change.size(); ++r) change[r] -= given[r];
  for (size_t k = 0; k < loops.joints.size(); ++k) {
    const size_t first = rows.first_row(k), count = rows.first_row(k + 1) - first;
    const JointWrench more = joint_wrench(rows.rows().subspan(first, count),
                                          std::span(change).subspan(first, count), arms[k]);
    JointWrench& impulse = joints[loops.joints[k]].impulse;
    impulse.force += more.force;
    impulse.torque += more.torque;
  }
}

}  // namespace tumble
