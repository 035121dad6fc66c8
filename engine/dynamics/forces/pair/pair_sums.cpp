#include "engine/dynamics/forces/pair/pair_sums.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/forces/pair/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr size_t worth_a_thread = 64;

}  // namespace

Status PairSums::sum(const PairLaw& law, const Points& points, Crew* crew) {
  if (Status done = push(law, points, crew); !done) return done;
  return measure(law, points, crew);
}

Status PairSums::push(const PairLaw& law, const Points& points, Crew* crew) {
  if (Status ready = prepare(law, points, crew); !ready) return ready;
  const size_t n = points.x.size();
  forces_.resize(n);
  const auto store = [&](size_t index, const PairPush& f) {
    const double w = points.weights[index];
    forces_[index] = {w * f.fx, w * f.fy, w * f.fz};
  };
  for_chunks(
      crew, n,
      [&](size_t chunk, size_t first, size_t last) {
        for (size_t p = first; p < last; ++p)
          if (law.ends()) {
            const Near others = near(law, p, lists_.of(p), near_[chunk]);
            store(lists_.order()[p], push_of(law, others.own, others.in_reach));
          } else {
            store(p, push_of_all(law, points_, n, p));
          }
      },
      worth_a_thread);
  return {};
}

Status PairSums::measure(const PairLaw& law, const Points& points, Crew* crew) {
  if (Status ready = prepare(law, points, crew); !ready) return ready;
  const size_t n = points.x.size();
  energies_.resize(n);
  const auto store = [&](size_t index, const PairEnergy& e) {
    const double w = points.weights[index];
    energies_[index] = {w * e.energy, w * e.virial};
  };
  for_chunks(
      crew, n,
      [&](size_t chunk, size_t first, size_t last) {
        for (size_t p = first; p < last; ++p)
          if (law.ends()) {  // each pair once, with the point whose index is less
            const auto list = lists_.of(p).subspan(lists_.before(p));
            const Near later = near(law, p, list, near_[chunk]);
            store(lists_.order()[p], energy_of(law, later.own, later.in_reach));
          } else {
            store(p, energy_of_later(law, points_, n, p));
          }
      },
      worth_a_thread);
  energy_ = virial_ = 0;
  for (const PairEnergy& e : energies_) energy_ += e.energy, virial_ += e.virial;
  return {};
}

PairSums::Near PairSums::near(const PairLaw& law, size_t place, std::span<const uint32_t> list,
                              std::vector<PairPoint>& store) const {
  if (store.size() < list.size() + pair_batch) store.resize(2 * list.size() + pair_batch);
  PairPoint own = points_[place];
  const double cutoff2 = law.cutoff * law.cutoff;
  size_t found = 0;
  if (!lists_.strayed(place)) {
    found = find_near(points_.data(), own, list, cutoff2, store.data());
  } else {
    // Differences of coordinates are rounded: as they are where lists are made now.
    const auto seen = [&](size_t other) {
      const Vec3 x = lists_.beside(place, other);
      return PairPoint{x[0], x[1], x[2], points_[other].weight};
    };
    own = seen(place);
    for (const uint32_t other : list) {
      store[found] = seen(other);
      const double dx = store[found].x - own.x, dy = store[found].y - own.y,
                   dz = store[found].z - own.z;
      found += (dx * dx + dy * dy) + dz * dz <= cutoff2 ? 1 : 0;
    }
  }
  return {own, {store.data(), fill_up(store.data(), found, own, law.cutoff)}};
}

Status PairSums::prepare(const PairLaw& law, const Points& points, Crew* crew) {
  near_.resize(chunk_count);
  if (law.ends()) return update_lists(law, points, crew);
  if (points.box.any())
    return Error{ErrorCode::invalid_argument,
                 "a pair potential without a cut-off in a periodic box", "pair potential",
                 "give it a cutoff"};
  const size_t n = points.x.size(), filled = (n + pair_batch - 1) / pair_batch * pair_batch;
  points_.assign(filled, {});
  for (size_t i = 0; i < n; ++i)
    points_[i] = {points.x[i][0], points.x[i][1], points.x[i][2], points.weights[i]};

  return {};
}

Status PairSums::update_lists(const PairLaw& law, const Points& points, Crew* crew) {
  NeighbourLists::Request request{
      .reach = law.cutoff, .skin = skin_, .box = points.box, .by_index = true};
  if (!lists_.hold(points.x, request, crew)) request.skin = next_skin(points, law.cutoff);
  const auto made = lists_.update(points.x, request, crew);
  if (!made) return made.error();
  skin_ = request.skin;
  made_ += *made ? 1 : 0;
  updates_ = *made ? 1 : updates_ + 1;
  points_.resize(lists_.places());
  const auto put = [&](size_t place, size_t owner) {
    points_[place] = {lists_.x()[place], lists_.y()[place], lists_.z()[place],
                      points.weights[lists_.order()[owner]]};
  };
  for_chunks(crew, lists_.size(), [&](size_t, size_t first, size_t last) {
    for (size_t p = first; p < last; ++p) put(p, p);
  });
  for (size_t g = 0; g < lists_.ghost_owners().size(); ++g)
    put(lists_.size() + g, lists_.ghost_owners()[g]);
  points_.back() = {lists_.x().back(), lists_.y().back(), lists_.z().back(), 0};
  return {};
}

/// A sum over lists of a skin s costs as the cube of r + s, and lists that have lasted for N sums
/// with this skin last for N s' / skin with another, so that their making costs as its inverse. The
/// least of both together is where s' (1 + s'/r) = sqrt(B skin r / (3 N)), B being the price of
/// making lists in sums.
double PairSums::next_skin(const Points& points, double reach) const {
  double skin = tolerances::first_skin * reach;
  // Lists that did not last for a second sum may have been of other points.
  if (skin_ > 0 && updates_ > 1 && points.x.size() == lists_.size()) {
    const double q = std::sqrt(tolerances::price_of_lists * skin_ / (3 * reach * double(updates_)));
    skin = reach * std::clamp(0.5 * (std::sqrt(1 + 4 * q) - 1), tolerances::least_skin,
                              tolerances::largest_skin);
  }
  for (int k = 0; k < 3; ++k)
    if (points.box.along(k)) skin = std::min(skin, points.box.size[k] - reach);
  return std::max(skin, 0.0);
}

}  // namespace tumble
