#include "engine/dynamics/forces/pair/pair_sums.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/forces/pair/pair_kernels.hpp"

#include <numeric>

namespace tumble {

Status PairSums::sum(const PairLaw& law, const Points& points, Crew* crew) {
  const size_t n = points.x.size();
  forces_.resize(n), energies_.resize(n), virials_.resize(n);
  const auto store = [&](size_t index, const PairSum& s) {
    forces_[index] = {s.fx, s.fy, s.fz};
    energies_[index] = s.energy;
    virials_[index] = s.virial;
  };
  constexpr size_t worth_a_thread = 64;
  if (law.ends()) {
    const auto made = lists_.update(points.x, {.reach = law.cutoff, .box = points.box}, crew);
    if (!made) return made.error();
    place_weights(points.weights);
    const PairPoints by_place{lists_.x().data(), lists_.y().data(), lists_.z().data(),
                              weight_.data()};
    for_chunks(
        crew, n,
        [&](size_t, size_t first, size_t last) {
          for (size_t p = first; p < last; ++p)
            store(lists_.order()[p], sum_over_list(law, by_place, p, lists_.of(p)));
        },
        worth_a_thread);
  } else {
    if (points.box.any())
      return Error{ErrorCode::invalid_argument,
                   "a pair potential without a cut-off in a periodic box", "pair potential",
                   "give it a cutoff"};
    const size_t filled =
        (n + NeighbourLists::batch - 1) / NeighbourLists::batch * NeighbourLists::batch;
    x_.assign(filled, 0), y_.assign(filled, 0), z_.assign(filled, 0), weight_.assign(filled, 0);
    for (size_t i = 0; i < n; ++i) {
      x_[i] = points.x[i][0], y_[i] = points.x[i][1], z_[i] = points.x[i][2];
      weight_[i] = points.weights[i];
    }
    const PairPoints by_index{x_.data(), y_.data(), z_.data(), weight_.data()};
    for_chunks(
        crew, n,
        [&](size_t, size_t first, size_t last) {
          for (size_t i = first; i < last; ++i) store(i, sum_over_all(law, by_index, i, filled));
        },
        worth_a_thread);
  }
  // Each pair was in the sums of both of its points.
  energy_ = 0.5 * std::accumulate(energies_.begin(), energies_.end(), 0.0);
  virial_ = 0.5 * std::accumulate(virials_.begin(), virials_.end(), 0.0);
  return {};
}

void PairSums::place_weights(std::span<const double> weights) {
  weight_.resize(lists_.places());
  for (size_t p = 0; p < lists_.size(); ++p) weight_[p] = weights[lists_.order()[p]];
  for (size_t g = 0; g < lists_.ghost_owners().size(); ++g)
    weight_[lists_.size() + g] = weight_[lists_.ghost_owners()[g]];
  weight_.back() = 0;
}

}  // namespace tumble
