// Exact forward dynamics of a robot: Atlas, 1.9 m tall, of 29 hinges, as Simbody brings it,
// floating and bent in every hinge: an evaluation of all accelerations, and a step of 1 ms by a
// Runge-Kutta method of fourth order (Simbody's is Merson's, of five evaluations; DART has none,
// and gets the classical one around its accelerations). All libraries have the robot as Tumble
// reads it; links that are welded on are part of what they are welded to, and limits, motors and
// friction of joints are left out. Answers of an evaluation: sum of the hinges' own accelerations
// [rad/s2], which must agree. Of a step: the height of the last link [m].
#include "engine/math/dense.hpp"
#include "engine/scene/robot_files/robot_parts.hpp"
#include "tests/bench/contest.hpp"
#include "tests/bench/trees/tree.hpp"

#include <cmath>
#include <stdexcept>

using namespace tumble;
using namespace tumble::bench;

namespace {

constexpr const char* atlas =
    "/usr/share/doc/simbody/examples/src/TaskSpaceControl-Atlas/models/atlas_v4.urdf.gz";

/// Adds the mass of a link that is welded on, which stands at `at` in the link's frame.
void weld_on(TreeLink& link, const Eigen::Isometry3d& at, const MassProperties& m) {
  if (m.mass == 0) return;
  const auto about = [](double mass, const Eigen::Vector3d& arm) -> Eigen::Matrix3d {
    return mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  };
  const Eigen::Vector3d centre = at * Eigen::Vector3d(dense(m.centre));
  const Eigen::Matrix3d own = at.linear() * dense(m.inertia) * at.linear().transpose();
  const double mass = link.mass + m.mass;
  const Eigen::Vector3d common = (link.mass * link.centre + m.mass * centre) / mass;
  link.inertia += about(link.mass, link.centre - common) + own + about(m.mass, centre - common);
  link.centre = common;
  link.mass = mass;
}

TreeScene read_robot(const std::string& file) {
  RobotLog log;
  const RobotModel model = read_robot_file(file, {}, log);
  if (!log.ok()) throw std::runtime_error(file + " cannot be read");
  TreeScene scene;
  scene.gravity = {0, 0, -9.81};
  struct Part {
    int link;
    Eigen::Isometry3d at;  ///< of the robot's link in that of the tree
  };
  std::vector<Part> parts;
  for (const RobotLink& l : model.links) {
    const Quat& q = l.in_parent.q;
    const Eigen::Isometry3d in_parent =
        Eigen::Translation3d(dense(l.in_parent.x)) * Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z());
    const bool root = l.parent == RobotLink::world;
    const Part before = root ? Part{-1, Eigen::Isometry3d::Identity()} : parts[l.parent];
    if (!root && l.joints.empty()) {
      parts.push_back({before.link, before.at * in_parent});
    } else {
      const int number = int(scene.links.size());
      TreeLink& link = scene.links.emplace_back();
      link.parent = before.link;
      link.free = root;
      link.in_parent = before.at * in_parent;
      if (!root) {
        if (l.joints.size() != 1 || !l.joints[0].anchor.isZero(0))
          throw std::runtime_error(l.name + ": only plain hinges are compared");
        link.axis = dense(l.joints[0].axis).normalized();
        link.angle = 0.4 * std::sin(1.7 * number);
        link.rate = 0.5 * std::cos(2.3 * number);
      }
      parts.push_back({number, Eigen::Isometry3d::Identity()});
    }
    weld_on(scene.links[size_t(parts.back().link)], parts.back().at, l.mass);
  }
  return scene;
}

bool compare(const TreeScene& scene) {
  constexpr int repeats = 100;
  struct Peer {
    const char* name;
    std::unique_ptr<TreePeer> tree;
  };
  std::vector<Peer> peers;
  peers.push_back({"Simbody", simbody_tree(scene)});
  peers.push_back({"tumble", tumble_tree(scene)});
  peers.push_back({"MuJoCo", mujoco_tree(scene)});
  peers.push_back({"DART", dart_tree(scene)});
  bool right = true;
  for (const bool step : {false, true}) {
    std::vector<Candidate> candidates;
    for (const Peer& peer : peers)
      candidates.push_back({peer.name, [&peer, step] {
                              double answer = 0;
                              for (int k = 0; k < repeats; ++k)
                                answer = step ? peer.tree->step() : peer.tree->evaluate();
                              return answer;
                            }});
    const auto timings = report("Atlas, " + std::to_string(scene.links.size()) + " links, 100 " +
                                    (step ? "steps" : "evaluations"),
                                candidates, 9);
    for (const Timing& t : timings)
      right &= step || std::fabs(t.answer - timings[0].answer) < 1e-6 * timings[0].answer;
  }
  if (!right) std::printf("  THE ANSWERS DIFFER\n");
  return right;
}

}  // namespace

int main(int argc, char** argv) {
  return compare(read_robot(argc > 1 ? argv[1] : atlas)) ? 0 : 1;
}
