// Exact forward dynamics of chains of hinged rods, open ones of 10 to 10,000 links and a closed one
// of 100 in ball joints: an evaluation of all accelerations, and a step of 1 ms by a Runge-Kutta
// method of fourth order (Simbody's is Merson's, of five evaluations). Ours and Simbody
// (Featherstone's articulated bodies) are linear in the links; MuJoCo factorises the matrix of
// joint coordinates, of which a chain has n^2 / 2 entries, and stops here at 1000, as DART does,
// which has articulated bodies too and takes open chains only. Answers of an
// evaluation: sum of the joints' own accelerations [rad/s2], which must agree, but for MuJoCo's
// closed chain, whose closure is soft. Of a step: the tip's height [m], which differs by the steps
// that were taken. Argument: the most links (default 10,000).
#include "tests/bench/chains/chain.hpp"
#include "tests/bench/contest.hpp"
#include "tests/bench/trees/tree.hpp"

#include <cmath>
#include <cstdlib>

using namespace tumble::bench;

namespace {

bool check(const std::vector<Timing>& timings, size_t exact) {
  for (size_t i = 0; i < exact; ++i)
    if (std::fabs(timings[i].answer - timings[0].answer) > 1e-6 * std::fabs(timings[0].answer)) {
      std::printf("  THE ANSWERS DIFFER\n");
      return false;
    }
  return true;
}

/// An open chain, whose links' frames are on their hinges.
TreeScene tree_of(const ChainScene& scene) {
  const auto vector = [](const Axis& v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  TreeScene out;
  out.gravity = {0, -gravity, 0};
  out.step = step_seconds;
  for (int i = 0; i < scene.links; ++i) {
    TreeLink& link = out.links.emplace_back();
    link.parent = i - 1;
    if (i > 0) link.in_parent = Eigen::Translation3d(rod_length, 0, 0);
    link.axis = vector(scene.axis(i));
    link.angle = scene.angle(i);
    link.rate = scene.rate(i);
    link.mass = rod_mass;
    link.centre = {rod_length / 2, 0, 0};
    link.inertia = vector(ChainScene::inertia()).asDiagonal();
  }
  return out;
}

/// DART among the others.
class ChainAsTree final : public ChainPeer {
 public:
  explicit ChainAsTree(std::unique_ptr<TreePeer> tree) : tree_(std::move(tree)) {}
  double evaluate() override { return tree_->evaluate(); }
  double step() override { return tree_->step(); }

 private:
  std::unique_ptr<TreePeer> tree_;
};

bool compare(const ChainScene& scene) {
  const int repeats = std::max(1, 2000 / scene.links);
  const auto simbody = simbody_chain(scene), ours = tumble_chain(scene);
  const auto mujoco = scene.links <= 1000 ? mujoco_chain(scene) : nullptr;
  std::unique_ptr<ChainPeer> dart;
  if (!scene.closed && scene.links <= 1000)
    dart = std::make_unique<ChainAsTree>(dart_tree(tree_of(scene)));
  const auto times = [repeats](double (ChainPeer::*what)(), ChainPeer& peer) {
    return [what, repeats, &peer] {
      double answer = 0;
      for (int k = 0; k < repeats; ++k) answer = (peer.*what)();
      return answer;
    };
  };
  const std::string title = std::string(scene.closed ? "closed" : "open") + " chain of " +
                            std::to_string(scene.links) + " links, " + std::to_string(repeats);
  bool right = true;
  for (const bool step : {false, true}) {
    const auto what = step ? &ChainPeer::step : &ChainPeer::evaluate;
    std::vector<Candidate> candidates{{"Simbody", times(what, *simbody)},
                                      {"tumble", times(what, *ours)}};
    if (mujoco) candidates.push_back({"MuJoCo", times(what, *mujoco)});
    if (dart) candidates.push_back({"DART", times(what, *dart)});
    const auto timings = report(title + (step ? " steps" : " evaluations"), candidates, 9);
    if (!step) right &= check(timings, scene.closed ? 2 : candidates.size());
  }
  return right;
}

}  // namespace

int main(int argc, char** argv) {
  const int most = argc > 1 ? std::atoi(argv[1]) : 10000;
  bool right = true;
  for (const int links : {10, 20, 100, 1000, 10000})
    if (links <= most) right &= compare({links, false});
  if (most >= 100) right &= compare({100, true});
  return right ? 0 : 1;
}
