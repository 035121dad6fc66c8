#include "engine/dynamics/joints/folded_trees.hpp"

#include "engine/core/work_meter.hpp"
#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>

namespace tumble {

namespace {

/// Calls f with the number as a template argument.
template <class F>
void with_freedoms(uint8_t freedoms, const F& f) {
  switch (freedoms) {
    case 0:
      return f.template operator()<0>();
    case 1:
      return f.template operator()<1>();
    case 2:
      return f.template operator()<2>();
    case 3:
      return f.template operator()<3>();
    case 4:
      return f.template operator()<4>();
    case 5:
      return f.template operator()<5>();
    default:
      return f.template operator()<6>();
  }
}

}  // namespace

FoldedTrees::FoldedTrees(std::span<const FoldedJoint> joints, size_t blocks, size_t rows)
    : node_of_(blocks, none), depends_(rows), passing_(joints.size()) {
  for (const FoldedJoint& j : joints) {
    node_of_[j.child] = uint32_t(blocks_.size());
    blocks_.push_back(j.child);
  }
  size_t free = 0;
  for (const FoldedJoint& j : joints) {
    if (j.parent != no_block && node_of_[j.parent] == none) {
      node_of_[j.parent] = uint32_t(blocks_.size());
      blocks_.push_back(j.parent);
    }
    Link& link = joints_.emplace_back();
    link.first_row = j.first_row;
    link.parent = j.parent == no_block ? none : node_of_[j.parent];
    link.side = j.side, link.parts = j.parts, link.drives = j.drives;
    link.free = free;
    free += 3 * folding::most_freedoms * folding::most_freedoms +
            size_t(j.drives) * (6 + 2 * folding::most_freedoms + size_t(j.drives));
  }
  free_.resize(free);
  tensors_.resize(blocks_.size());
  pushes_.resize(blocks_.size());
  motions_.resize(blocks_.size());
}

double* FoldedTrees::drives_of(const Link& link) {
  return &free_[link.free + 3 * folding::most_freedoms * folding::most_freedoms];
}
const double* FoldedTrees::drives_of(const Link& link) const {
  return &free_[link.free + 3 * folding::most_freedoms * folding::most_freedoms];
}

/// With rows E x + g f = change on the coordinates x, H becomes H - H E (E H E^T + g)^-1 E^T H.
void FoldedTrees::add_drives(Link& link, std::span<const JointRow> rows,
                             std::span<const double> give) {
  const size_t k = link.freedoms, m = link.drives;
  double* const S = &free_[link.free];
  double* const H = S + 12 * k;
  double* const along = drives_of(link);  // 6 m, then L: k m, then B: m m
  double* const L = along + 6 * m;
  double* const B = L + folding::most_freedoms * m;
  std::array<double, folding::most_freedoms * folding::most_freedoms> felt,
      left;  // H E, E H E^T + g
  std::array<double, folding::most_freedoms> of_axes;
  for (size_t d = 0; d < m; ++d) {
    const size_t row = link.first_row + link.parts + d;
    const RowSide& s = link.side == 0 ? rows[row].row.a : rows[row].row.b;
    folding::put(along + 6 * d, s.linear, s.angular);
    for (size_t i = 0; i < k; ++i) {
      felt[k * d + i] = 0;
      for (size_t j = 0; j < k; ++j)
        felt[k * d + i] += H[k * j + i] * folding::dot(along + 6 * d, S + 6 * j);
    }
  }
  for (size_t d = 0; d < m; ++d) {
    for (size_t i = 0; i < k; ++i) of_axes[i] = folding::dot(along + 6 * d, S + 6 * i);
    for (size_t e = 0; e < m; ++e) {
      double sum = d == e ? give[link.first_row + link.parts + d] : 0;
      for (size_t i = 0; i < k; ++i) sum += of_axes[i] * felt[k * e + i];
      left[m * d + e] = sum;
    }
  }
  const uint32_t lost = folding::invert(m, left.data(), tolerances::no_drive, B);
  for (size_t d = 0; d < m; ++d) depends_[link.first_row + link.parts + d] = uint8_t(lost >> d & 1);
  for (size_t d = 0; d < m; ++d)
    for (size_t i = 0; i < k; ++i) {
      L[k * d + i] = 0;
      for (size_t e = 0; e < m; ++e) L[k * d + i] += felt[k * e + i] * B[m * d + e];
    }
  for (size_t d = 0; d < m; ++d)
    for (size_t j = 0; j < k; ++j)
      for (size_t i = 0; i < k; ++i) H[k * j + i] -= L[k * d + i] * felt[k * d + j];
}

template <int freedoms>
void FoldedTrees::eliminate(Link& link, const Tensor& tensor, std::span<const JointRow> rows,
                            std::span<const double> give) {
  constexpr size_t k = freedoms;
  double* const S = &free_[link.free];
  double* const U = S + 6 * k;
  double* const H = U + 6 * k;
  std::array<double, 6 * k> x{};
  for (size_t c = 0; c < k; ++c) folding::add_product(tensor, S + 6 * c, &x[6 * c]);
  std::copy(x.begin(), x.end(), U);
  if constexpr (k == 1) {
    H[0] = 1 / folding::dot(S, U);
  } else if constexpr (k > 1) {
    std::array<double, k * k> own;
    for (size_t c = 0; c < k; ++c)
      for (size_t r = 0; r < k; ++r) own[k * c + r] = folding::dot(S + 6 * r, U + 6 * c);
    folding::invert(k, own.data(), tolerances::no_pivot, H);
  }
  if (link.drives > 0) add_drives(link, rows, give);
  link.passed = tensor;
  for (size_t c = 0; c < k; ++c) {
    std::array<double, 6> felt{};
    for (size_t i = 0; i < k; ++i)
      for (size_t r = 0; r < 6; ++r) felt[r] += H[k * c + i] * U[6 * i + r];
    for (size_t j = 0; j < 6; ++j)
      for (size_t r = 0; r < 6; ++r) link.passed[6 * j + r] -= felt[r] * U[6 * c + j];
  }
}

void FoldedTrees::factor(std::span<const JointRow> rows, std::span<const double> give,
                         std::span<const DofBlock> blocks, std::span<const Mat3> inertias) {
  charge_work(tolerances::folded_factor_price, joints_.size());
  const folding::Bodies bodies{blocks, inertias};
  for (size_t i = 0; i < blocks_.size(); ++i) bodies.tensor(blocks_[i], tensors_[i]);
  for (size_t i = 0; i < joints_.size(); ++i) {
    Link& link = joints_[i];
    const size_t own_rows = size_t(link.parts) + link.drives;
    link.look(rows.subspan(link.first_row, own_rows),
              std::span(depends_).subspan(link.first_row, own_rows));
    link.free_axes(&free_[link.free]);
    with_freedoms(link.freedoms, [&]<int k>() { eliminate<k>(link, tensors_[i], rows, give); });
    if (link.parent != none) folding::add_moved(link.passed, link.to_parent, tensors_[link.parent]);
  }
  for (size_t i = joints_.size(); i < tensors_.size(); ++i) {
    const Tensor root = tensors_[i];
    folding::invert(6, root.data(), tolerances::no_pivot, tensors_[i].data());
  }
  dependent_ = 0;
  for (const uint8_t d : depends_) dependent_ += d;
}

FoldedTrees::Six FoldedTrees::answer(uint32_t root, const RowSide& push) const {
  Six by, out{};
  folding::put(by.data(), push.linear, push.angular);
  folding::add_product(tensors_[node_of_[root]], by.data(), out.data());
  return out;
}

template <int freedoms>
void FoldedTrees::gather(const Link& link, const Six& push, std::span<const double> change,
                         Passing& out) const {
  constexpr size_t k = freedoms;
  const double* const S = &free_[link.free];
  const double* const U = S + 6 * k;
  const double* const H = U + 6 * k;
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  for (size_t i = 0; i < link.turns; ++i) angular += change[link.turn_row[i]] * link.dual[i];
  for (size_t i = 0; i < link.lines; ++i)
    linear += (change[link.line_row[i]] - link.arm[i].dot(angular)) * link.line[i];
  folding::put(out.across.data(), linear, angular);
  out.push = push;
  folding::add_product(link.passed, out.across.data(), out.push.data());
  std::array<double, k> felt;
  for (size_t i = 0; i < k; ++i) out.felt[i] = felt[i] = folding::dot(S + 6 * i, push.data());
  for (size_t i = 0; i < k; ++i) {
    out.slack[i] = 0;
    for (size_t j = 0; j < k; ++j) out.slack[i] -= H[k * j + i] * felt[j];
  }
  if (link.drives > 0) {
    const size_t m = link.drives;
    const double* const along = drives_of(link);
    const double* const L = along + 6 * m;
    for (size_t d = 0; d < m; ++d) {
      out.driven[d] = change[link.parts + d] - folding::dot(along + 6 * d, out.across.data());
      for (size_t i = 0; i < k; ++i) out.slack[i] += L[k * d + i] * out.driven[d];
    }
  }
  for (size_t i = 0; i < k; ++i)
    for (size_t r = 0; r < 6; ++r) out.push[r] += U[6 * i + r] * out.slack[i];
}

void FoldedTrees::gather(std::span<const double> change) const {
  charge_work(tolerances::folded_solve_price, joints_.size());
  for (Six& p : pushes_) p.fill(0);
  for (size_t i = 0; i < joints_.size(); ++i) {
    const Link& link = joints_[i];
    with_freedoms(link.freedoms, [&]<int k>() {
      gather<k>(link, pushes_[i], change.subspan(link.first_row), passing_[i]);
    });
    if (link.parent == none) continue;
    const double* const push = passing_[i].push.data();
    const Vec3 f = folding::linear_of(push);
    const Vec3 torque = folding::angular_of(push) + link.to_parent.cross(f);
    double* const to = pushes_[link.parent].data();
    folding::put(to, folding::linear_of(to) + f, folding::angular_of(to) + torque);
  }
  for (size_t i = joints_.size(); i < tensors_.size(); ++i) {
    motions_[i].fill(0);
    folding::add_product(tensors_[i], pushes_[i].data(), motions_[i].data());
    for (double& v : motions_[i]) v = -v;
  }
}

/// Computes the forces of the rows from the push on the child.
void FoldedTrees::take_forces(const Link& link, const Six& push, std::span<double> change) const {
  const Vec3 force = folding::linear_of(push.data());
  Vec3 torque = folding::angular_of(push.data());
  for (size_t i = 0; i < link.parts; ++i)
    if (depends_[link.first_row + i]) change[i] = 0;
  for (size_t i = 0; i < link.lines; ++i) {
    const double f = link.line[i].dot(force);
    change[link.line_row[i]] = f;
    torque -= f * link.arm[i];
  }
  for (size_t i = 0; i < link.turns; ++i) change[link.turn_row[i]] = link.dual[i].dot(torque);
}

template <int freedoms>
void FoldedTrees::spread(const Link& link, const Passing& in, const Six& before, Six& motion,
                         std::span<double> change) const {
  constexpr size_t k = freedoms;
  const double* const S = &free_[link.free];
  const double* const U = S + 6 * k;
  const double* const H = U + 6 * k;
  Six push = in.push;
  folding::add_product(link.passed, before.data(), push.data());
  for (size_t r = 0; r < 6; ++r) motion[r] = before[r] + in.across[r];
  std::array<double, k> goes, felt;
  for (size_t i = 0; i < k; ++i) felt[i] = folding::dot(U + 6 * i, motion.data());
  for (size_t i = 0; i < k; ++i) {
    goes[i] = in.slack[i];
    for (size_t j = 0; j < k; ++j) goes[i] -= H[k * j + i] * felt[j];
  }
  for (size_t i = 0; i < k; ++i)
    for (size_t r = 0; r < 6; ++r) motion[r] += S[6 * i + r] * goes[i];
  if (link.drives > 0) take_drives(link, in, felt, push, change);
  take_forces(link, push, change);
}

/// Computes the forces of the drives and subtracts them from the push on the child; `felt` is its
/// part along the free axes without their motion.
void FoldedTrees::take_drives(const Link& link, const Passing& in, std::span<const double> felt,
                              Six& push, std::span<double> change) const {
  const size_t k = felt.size(), m = link.drives;
  const double* const along = drives_of(link);
  const double* const L = along + 6 * m;
  const double* const B = L + folding::most_freedoms * m;
  for (size_t d = 0; d < m; ++d) {
    double f = 0;
    for (size_t e = 0; e < m; ++e) f += B[m * e + d] * in.driven[e];
    for (size_t i = 0; i < k; ++i) f += L[k * d + i] * (felt[i] + in.felt[i]);
    change[link.parts + d] = f;
    for (size_t r = 0; r < 6; ++r) push[r] -= f * along[6 * d + r];
  }
}

void FoldedTrees::spread(std::span<double> change) const {
  for (size_t i = joints_.size(); i-- > 0;) {
    const Link& link = joints_[i];
    Six before{};
    if (link.parent != none) {
      const double* const of_parent = motions_[link.parent].data();
      const Vec3 turning = folding::angular_of(of_parent);
      folding::put(before.data(), folding::linear_of(of_parent) + turning.cross(link.to_parent),
                   turning);
    }
    with_freedoms(link.freedoms, [&]<int k>() {
      spread<k>(link, passing_[i], before, motions_[i], change.subspan(link.first_row));
    });
  }
}

}  // namespace tumble
