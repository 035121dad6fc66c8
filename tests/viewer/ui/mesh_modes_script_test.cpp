// References: what the world's body is made of before and after, and its state hash.
#include "engine/world/world.hpp"
#include "tests/viewer/ui/session_rig.hpp"

#include <chrono>
#include <thread>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Pictures until something that another thread does has happened; a minute at most.
template <class Happened>
bool wait_for(Rig& rig, const Happened& happened) {
  for (int n = 0; n < 6000 && !happened(); ++n) {
    rig.frame();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return happened();
}

}  // namespace

TEST_CASE("a mesh is let collide in another way, which is one deed, and all ways are compared") {
  const auto device = make_null_device();
  Rig rig(*device, "meshes");
  rig.picture = {1200, 900, 1};
  rig.play("wait 5\nkey Space\nclick body:ring\nwait 3");
  const auto shapes = [&] {
    World& world = rig.app->session().world();
    return world.body(world.find_body("ring"))->shapes.size();
  };
  const auto state = [&] { return rig.app->session().world().state_hash(); };
  REQUIRE(shapes() == 1);
  const uint64_t before = state();
  rig.play("click inspector.mesh.0.mode\nwait 2\nclick inspector.mesh.0.mode.decomposition");
  REQUIRE(wait_for(rig, [&] { return shapes() > 3; }));
  rig.play("wait 3\nkey Ctrl+Z\nwait 3");
  CHECK(says(rig, "Taken back: Let the mesh of ring collide as decomposition"));
  CHECK(shapes() == 1);
  CHECK(state() == before);
  rig.play("key Ctrl+Y\nwait 3");
  CHECK(shapes() > 3);
  // From pieces to a primitive: the mesh is known still.
  rig.play("click inspector.mesh.0.mode\nwait 2\nclick inspector.mesh.0.mode.fit");
  REQUIRE(wait_for(rig, [&] { return shapes() == 1; }));
  CHECK(wait_for(rig, [&] { return says(rig, "approximate"); }));

  const auto compared = [&] { return rig.app->locate("inspector.mesh.0.table").has_value(); };
  CHECK_FALSE(compared());
  rig.play("click inspector.mesh.0.compare\nwait 2");
  CHECK(wait_for(rig, compared));
  check_no_faults(*device);
}
