#include "engine/geometry/isosurface/sparse_field.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {

const SparseField::Brick* SparseField::find(const GridIndex& at) const {
  const auto found =
      std::lower_bound(bricks.begin(), bricks.end(), at,
                       [](const Brick& brick, const GridIndex& to) { return brick.at < to; });
  return found != bricks.end() && found->at == at ? &*found : nullptr;
}

Status check_spacing(double spacing, const Aabb& box) {
  if (!(spacing > 0) || !std::isfinite(spacing))
    return Error{ErrorCode::invalid_argument,
                 fmt::format("the cells of a surface must be > 0 m, got {} m", spacing),
                 {},
                 {}};
  if (box.empty()) return {};
  constexpr double most_nodes = double(1 << 30);  // so that indices of neighbours are in range too
  const double farthest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if (farthest <= most_nodes * spacing) return {};
  return Error{ErrorCode::invalid_argument,
               fmt::format("cells of {} m are too small for what is {} m from the origin", spacing,
                           farthest),
               {},
               fmt::format("{} m or more would do", farthest / most_nodes)};
}

Result<SparseField> sample_field(const std::function<double(const Vec3&)>& f, const Aabb& box,
                                 double spacing) {
  if (Status fine = check_spacing(spacing, box); !fine) return fine.error();
  SparseField out;
  out.spacing = spacing;
  if (box.empty()) return out;
  constexpr int edge = SparseField::edge;
  const Array3<double> first = (box.min / (spacing * edge)).array().floor(),
                       last = (box.max / (spacing * edge)).array().floor();
  const double count = (last - first + 1).prod();
  if (count > double(most_bricks))
    return Error{ErrorCode::invalid_argument,
                 fmt::format("{} bricks of cells of {} m are too many", count, spacing),
                 {},
                 fmt::format("{} m would do", 1.1 * spacing * std::cbrt(count / most_bricks))};
  const Array3<int> a = first.cast<int>(), b = last.cast<int>();
  for (int i = a[0]; i <= b[0]; ++i)
    for (int j = a[1]; j <= b[1]; ++j)
      for (int k = a[2]; k <= b[2]; ++k) {
        SparseField::Brick& brick = out.bricks.emplace_back();
        brick.at = {i, j, k};
        size_t n = 0;
        for (int z = 0; z < edge; ++z)
          for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x)
              brick.value[n++] = f(out.position({edge * i + x, edge * j + y, edge * k + z}));
      }
  return out;
}

}  // namespace tumble
