// Damaged robot files: each is read, or refused with a file and a cause; what is read can be built
// into a scene or is refused there. Reference: that nothing else happens.
#include "engine/core/random.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/robots/robot_text.hpp"

#include <iterator>

using namespace tumble;
using namespace tumble::test;

namespace {

const std::string whole_urdf = R"(<robot name="r">
<material name="m"><color rgba="1 0 0 1"/></material>
<link name="a"><inertial><origin xyz="0 0 1" rpy="0 0 1"/><mass value="2"/>
<inertia ixx="3" ixy="0.1" ixz="0" iyy="4" iyz="0" izz="5"/></inertial>
<visual><geometry><box size="1 2 3"/></geometry><material name="m"/></visual>
<collision><geometry><capsule radius="0.1" length="1"/></geometry></collision></link>
<link name="b"><inertial><mass value="1"/></inertial>
<collision><geometry><sphere radius="0.5"/></geometry></collision></link>
<link name="c"/><link name="d"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="5" velocity="1"/><dynamics damping="0.5" friction="0.1"/></joint>
<joint name="k" type="prismatic"><parent link="b"/><child link="c"/><limit lower="0.1" upper="1" effort="5"/>
<mimic joint="j" multiplier="2"/></joint>
<joint name="l" type="continuous"><parent link="c"/><child link="d"/></joint></robot>)";

const std::string whole_mjcf =
    R"(<mujoco model="m"><compiler angle="radian" eulerseq="xyz" autolimits="true"/>
<default><geom density="500"/><default class="x"><joint damping="1" range="-1 1"/></default></default>
<asset><material name="r" rgba="1 0 0 1"/></asset><option gravity="0 0 -9"/>
<worldbody><geom type="plane" size="1 1 1"/><body name="a" pos="0 0 2" euler="0 1 0"><freejoint/>
<geom type="box" size="0.1 0.2 0.3" material="r"/><body name="b" pos="0 0 0.5" childclass="x">
<joint name="i" axis="1 0 0" armature="0.1"/><joint name="j" axis="0 1 0" ref="0.5"/>
<joint name="k" type="slide" axis="0 0 1"/><geom type="capsule" fromto="0 0 0 0 0 1" size="0.1"/>
<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></body>
<body name="c"><joint type="ball"/><geom size="0.1"/></body></worldbody>
<actuator><position joint="i" kp="3"/><velocity joint="k"/><motor joint="j" gear="2"/></actuator>
<equality><connect body1="a" body2="c" anchor="0 0 1"/><weld body1="c"/></equality>
<contact><exclude body1="a" body2="c"/></contact></mujoco>)";

/// Numbers, names and whole elements change places.
std::string mutated(std::string text, Random& random) {
  static const char* const pieces[] = {"0",   "-1",    "1e12", "nan",   "1e-300", "",    "a",
                                       "b",   "\"",    "<",    "/>",    "0 0 0",  "1 2", "&#0;",
                                       "0x1", "world", "free", "fixed", "1e999"};
  const uint32_t changes = 1 + random.below(4);
  for (uint32_t i = 0; i < changes && !text.empty(); ++i) {
    const size_t at = random.below(uint32_t(text.size()));
    switch (random.below(5)) {
      case 0: {
        const size_t open = text.find('"', at);
        const size_t close = open == std::string::npos ? open : text.find('"', open + 1);
        if (close != std::string::npos)
          text.replace(open + 1, close - open - 1,
                       pieces[random.below(uint32_t(std::size(pieces)))]);
        break;
      }
      case 1:
        text[at] = char(random.below(256));
        break;
      case 2:
        text.erase(at, 1 + random.below(40));
        break;
      case 3: {
        const std::string part = text.substr(at, 1 + random.below(200));
        text.insert(random.below(uint32_t(text.size())), part);
        break;
      }
      default:
        text.resize(at);
    }
  }
  return text;
}

struct Outcomes {
  int read = 0, refused = 0, built = 0;
};

void judge(const std::string& text, const std::string& name, Outcomes& out) {
  ReadRobot r = robot_of_text(text, name);
  if (r.log.ok()) {
    RobotParts parts = make_robot(r.model, {}, r.log);
    if (r.log.ok()) {
      ++out.read;
      WorldDef extras;
      extras.threads = 1;
      std::vector<Fault> faults;
      const auto built = build_world(parts.scene, extras, nullptr, &faults);
      CHECK((built.ok() || !faults.empty()));
      out.built += built.ok();
      if (built) CHECK(built->world->step().ok());
    }
  }
  if (!r.log.ok()) {
    ++out.refused;
    CHECK_FALSE(r.log.faults()[0].message.empty());
    CHECK(r.log.faults()[0].file == name);
  }
}

}  // namespace

TEST_CASE("damaged robot files are read or refused with a cause") {
  for (const auto& [text, name] :
       {std::pair(whole_urdf, "r.urdf"), std::pair(whole_mjcf, "m.xml")}) {
    CAPTURE(name);
    Outcomes whole;
    judge(text, name, whole);
    CHECK(whole.built == 1);
    Random random(20, uint64_t(name[0]));
    Outcomes out;
    const int count = scaled_count(400);
    for (int i = 0; i < count; ++i) {
      const std::string damaged = mutated(text, random);
      CAPTURE(damaged);
      judge(damaged, name, out);
    }
    CAPTURE(out.read);
    CAPTURE(out.built);
    if (count >= 100) {  // both happen often enough to mean something
      CHECK(out.read > count / 100);
      CHECK(out.refused > count / 5);
      CHECK(out.built > count / 100);
    }
  }
}
