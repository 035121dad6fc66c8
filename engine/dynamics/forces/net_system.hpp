#pragma once
#include "engine/dynamics/forces/net_pattern.hpp"
#include "engine/dynamics/forces/net_rows.hpp"
#include "engine/math/float4.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The system of SpringNet for nets with meshes. The matrix is put together in 3 x 3 blocks, two to
/// a body that turns. It is solved by conjugate gradients with the inverted blocks of its diagonal
/// as preconditioner, in single precision; what is left is found in double precision from the rows
/// and solved for again, until it is small.
class NetSystem {
 public:
  void solve(const SpringNet& net, SpringNet::Answer& out);

 private:
  void put_together();
  const uint32_t* put(const NetParts& parts, const Mat3& E, const uint32_t* place);
  const uint32_t* put_tie(size_t i, const uint32_t* place);
  const uint32_t* put_bow(size_t i, const uint32_t* place);
  void add_turning(const SpringNet::End& end, double turn);
  void invert_diagonal();
  void residual(std::vector<Vec3>& out) const;
  double size(std::span<const Vec3> r) const;
  int correct(std::span<const Vec3> r, double target);
  void apply(std::span<const Float4> x, std::span<Float4> y) const;
  void precondition(std::span<const Float4> r, std::span<Float4> y) const;
  void answer(SpringNet::Answer& out) const;
  void rest(std::vector<Vec3>& force, std::vector<Vec3>& torque) const;
  bool is_held() const;
  void take_rigid_motion(std::span<const Vec3> left, std::vector<Vec3>& force,
                         std::vector<Vec3>& torque) const;
  Vec3 moves_apart(const SpringNet::Tie& tie, const std::vector<Vec3>& x) const;
  Vec3 velocity(const SpringNet::End& end, const std::vector<Vec3>& x) const;
  void push(const SpringNet::End& end, const Vec3& impulse, std::vector<Vec3>& out) const;

  const SpringNet* net_ = nullptr;
  std::vector<NetRow> rows_;
  std::vector<NetBow> bows_;
  std::vector<double> stiffness_;
  NetPattern pattern_;
  std::vector<Rows3> off_;        ///< by place, transposed: combine() multiplies
  std::vector<Mat3> diagonal_;    ///< by block
  std::vector<Rows3> diagonal4_;  ///< the same in single precision
  std::vector<Rows3> inverse_;
  std::vector<Vec3> change_;  ///< of the velocities, by block
  std::vector<Vec3> r_;       ///< the residual
  std::vector<Float4> residual_, y_, p_, product_, correction_;
};

}  // namespace tumble
