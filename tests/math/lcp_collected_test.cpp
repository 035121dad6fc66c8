// Problems that the scene `arch` met when its stones settled, friction only holding them: dozens of
// cones, some at the edge between two states, some that slide in a prescribed direction. And some
// of a heap of boxes, with more points between two faces than their forces can be told apart by.
// References: the validator, which knows no solver, and where two solvers answer, each other.
#include "engine/math/lcp/blocks/block_solvers.hpp"
#include "engine/math/lcp/cones/solve_cones.hpp"
#include "engine/math/lcp/interior/cone_interior.hpp"
#include "engine/math/lcp/validate.hpp"
#include "tests/math/block_matrix.hpp"
#include "tests/math/block_text.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::lcp;

namespace {

std::vector<std::string> collected() {
  std::vector<std::string> files;
  for (const auto& e :
       std::filesystem::directory_iterator(std::string(TUMBLE_SOURCE_DIR) + "/tests/math/data"))
    files.push_back(e.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("redundant points of sliding faces are solved by Newton's method alone, to rounding") {
  int looked_at = 0;
  for (const std::string& file : collected()) {
    if (file.find("heap_of_boxes") == std::string::npos) continue;
    CAPTURE(file);
    const BlockProblem sparse = lcp_text::read(file);
    REQUIRE(sparse.size() > 0);
    const auto found = block_newton(sparse, {}, nullptr);
    REQUIRE(found.ok());
    CHECK(validate(with_matrix(sparse), found->z).worst() <= 1e-12);
    CHECK(found->report.iterations <= 40);
    ++looked_at;
  }
  CHECK(looked_at == 3);
}

TEST_CASE("collected problems, on which semi-smooth Newton stalled, are solved along the path") {
  int sliding = 0;
  const auto files = collected();
  REQUIRE(files.size() >= 3);
  for (const std::string& file : files) {
    CAPTURE(file);
    const BlockProblem sparse = lcp_text::read(file);
    REQUIRE(sparse.size() > 0);
    REQUIRE(check(sparse));
    for (const ConeGroup& g : sparse.conditions.groups) sliding += g.mode == ConeMode::sliding;
    const LcpProblem p = with_matrix(sparse);
    const auto s = cone_interior(p);
    REQUIRE(s.ok());
    CHECK(s->report.solved());
    CHECK(validate(p, s->z).worst() <= 1e-9);
    const auto t = block_interior(sparse);
    REQUIRE(t.ok());
    CHECK(t->report.solved());
    CHECK(validate(p, t->z).worst() <= 1e-9);
    const auto n = block_newton(sparse, {}, nullptr);
    REQUIRE(n.ok());
    if (n->report.solved()) CHECK(validate(p, n->z).worst() <= 2e-9);
  }
  CHECK(sliding > 0);
}

TEST_CASE("stalled problems go from stage to stage, and the answer says so") {
  int handed_over = 0;
  for (const std::string& file : collected()) {
    CAPTURE(file);
    const BlockProblem sparse = lcp_text::read(file);
    ConeTask task;
    task.problem = sparse.conditions;
    task.blocks = sparse;
    const ConeAnswer s = solve_cones(task);
    REQUIRE(s.found);
    CHECK(s.solution.report.solved());
    CHECK(validate(with_matrix(sparse), s.solution.z).worst() <= 1e-9);
    CHECK(s.attempts.front().stage == "blocks");
    const bool by_path = s.solution.report.solver == "cone_interior";
    CHECK(by_path == (s.attempts.back().stage == "block_path"));
    handed_over += by_path;
    // From its own answer Newton's method has nothing left to do, or cannot do better.
    task.start = s.solution.z;
    task.warm = true;
    const ConeAnswer again = solve_cones(task);
    CHECK(again.found);
    CHECK(again.solution.report.residual <= 1e-9);
  }
  CHECK(handed_over > 0);
}

TEST_CASE("problems are read as they were written") {
  const BlockProblem p = lcp_text::read(collected().front());
  const std::string copy = std::string(TUMBLE_BINARY_DIR) + "/block_problem.txt";
  lcp_text::write(p, copy);
  const BlockProblem q = lcp_text::read(copy);
  CHECK(with_matrix(p).A == with_matrix(q).A);
  CHECK(p.conditions.b == q.conditions.b);
  REQUIRE(p.conditions.groups.size() == q.conditions.groups.size());
  for (size_t i = 0; i < p.conditions.groups.size(); ++i)
    CHECK(p.conditions.groups[i].direction == q.conditions.groups[i].direction);
  CHECK(lcp_text::read("no such file").size() == 0);
}
