#pragma once
#include "engine/math/types.hpp"

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

/// Our values in MuJoCo's scene language, and its models from text.
namespace tumble::test {

inline std::string mujoco_text(const Vec3& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}
inline std::string mujoco_text(const Quat& q) {
  return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", q.w(), q.x(), q.y(), q.z());
}

/// Throws what MuJoCo says against the text.
inline mjModel* mujoco_model(const std::string& text) {
  mju_user_warning = [](const char*) {};
  auto* files = static_cast<mjVFS*>(std::malloc(sizeof(mjVFS)));
  mj_defaultVFS(files);
  mj_makeEmptyFileVFS(files, "case.xml", int(text.size()));
  std::memcpy(files->filedata[mj_findFileVFS(files, "case.xml")], text.data(), text.size());
  char error[1000] = "";
  mjModel* model = mj_loadXML("case.xml", files, error, sizeof error);
  mj_deleteVFS(files);
  std::free(files);
  if (!model) throw std::runtime_error(error);
  return model;
}

/// Pose and velocities of a body's centre of mass, after mj_kinematics, mj_comPos and mj_comVel.
inline void read_mujoco_body(const mjModel* model, const mjData* data, int id, Pose& pose, Vec3& v,
                             Vec3& omega) {
  mjtNum rates[6];
  mj_objectVelocity(model, data, mjOBJ_BODY, id, rates, 0);
  const mjtNum *x = data->xipos + 3 * id, *q = data->xquat + 4 * id;
  pose.x = Vec3(x[0], x[1], x[2]);
  pose.q = Quat(q[0], q[1], q[2], q[3]);
  v = Vec3(rates[3], rates[4], rates[5]);
  omega = Vec3(rates[0], rates[1], rates[2]);
}

}  // namespace tumble::test
