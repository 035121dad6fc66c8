#pragma once
#include <string>

namespace tumble::test {

/// Two robots that use much of what is read of each format, for files that are damaged on purpose.
inline const std::string whole_urdf = R"(<robot name="r">
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

inline const std::string whole_mjcf =
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

}  // namespace tumble::test
