#include "tests/support/mujoco_reader.hpp"

#include <memory>

#include <mujoco/mujoco.h>

namespace tumble::test {
namespace {

Vec3 vec(const mjtNum* v) {
  return {v[0], v[1], v[2]};
}

Mat3 mat(const mjtNum* m) {
  return {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]};
}

}  // namespace

MujocoModel read_by_mujoco(const std::string& file) {
  MujocoModel out;
  char error[1000] = "";
  const std::unique_ptr<mjModel, void (*)(mjModel*)> model(
      mj_loadXML(file.c_str(), nullptr, error, sizeof error), mj_deleteModel);
  if (!model) {
    out.error = error[0] ? error : "not read";
    return out;
  }
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.get()), mj_deleteData);
  const mjModel& m = *model;
  mj_kinematics(&m, data.get());
  mj_comPos(&m, data.get());
  for (int b = 1; b < m.nbody; ++b) {
    MujocoBody body;
    body.name = m.names + m.name_bodyadr[b];
    body.mass = m.body_mass[b];
    body.place = vec(data->xpos + 3 * b);
    body.centre = vec(data->xipos + 3 * b);
    const Mat3 R = mat(data->ximat + 9 * b);
    body.inertia = R * vec(m.body_inertia + 3 * b).asDiagonal() * R.transpose();
    out.bodies.push_back(body);
  }
  for (int j = 0; j < m.njnt; ++j) {
    MujocoJoint joint;
    joint.name = m.names + m.name_jntadr[j];
    joint.kind = m.jnt_type[j];
    joint.anchor = vec(data->xanchor + 3 * j);
    joint.axis = vec(data->xaxis + 3 * j);
    joint.limited = m.jnt_limited[j] != 0;
    joint.lower = m.jnt_range[2 * j];
    joint.upper = m.jnt_range[2 * j + 1];
    joint.stiffness = m.jnt_stiffness[j];
    const int dof = m.jnt_dofadr[j];
    joint.damping = m.dof_damping[dof];
    joint.armature = m.dof_armature[dof];
    joint.friction = m.dof_frictionloss[dof];
    out.joints.push_back(joint);
  }
  return out;
}

}  // namespace tumble::test
