#pragma once
#include "engine/collision/broad_phase/packed_bounds.hpp"
#include "engine/core/chunks.hpp"

namespace tumble {

/// Packed bounds with the indices of their proxies, in the order of a structure.
struct PackedSet {
  std::vector<PackedBounds> bounds;
  std::vector<uint32_t> ids;

  void resize(size_t n) {
    bounds.resize(n);
    ids.resize(n);
  }
  size_t size() const { return ids.size(); }
};

/// Tests packed bounds, decides in double precision where single precision is ambiguous, and
/// collects the pairs in any order; finish() sorts them. Each pair must be offered once. The
/// collection stops at far more pairs than a tick can process: with everything in one place they
/// would fill the memory.
class PairCollector {
 public:
  /// `owners`: BroadPhase::set_owners.
  void start(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> owners = {});
  /// Tests bounds against set[first, last).
  void test(const PackedBounds& a, uint32_t id, const PackedSet& set, size_t first, size_t last) {
    if (found_.size() >= most_pairs) return;
    stats_.tested += last - first;
    for (size_t k = first; k < last; ++k)
      if (may_overlap(a, set.bounds[k])) add(a, id, set.bounds[k], set.ids[k]);
  }
  /// Calls f(first, last, collector) for fixed chunks of [0, n), each with a collector of its own,
  /// on these threads; without threads, or with n below `least`, once with this collector.
  template <class F>
  void in_chunks(Crew* crew, size_t n, const F& f, size_t least = least_parallel) {
    if (!crew || n < least) return f(size_t{0}, n, *this);
    if (parts_.size() < chunk_count) parts_.resize(chunk_count);
    for (PairCollector& part : parts_) part.proxies_ = proxies_, part.owners_ = owners_;
    for_chunks(
        crew, n, [&](size_t chunk, size_t first, size_t last) { f(first, last, parts_[chunk]); },
        least);
  }
  /// Replaces `pairs` by the sorted list.
  BroadPhaseStats finish(std::vector<ProxyPair>& pairs, Crew* crew = nullptr);

 private:
  void add(const PackedBounds& a, uint32_t i, const PackedBounds& b, uint32_t j) {
    if (!owners_.empty() && owners_[i] == owners_[j]) return;
    if (!surely_overlap(a, b) && !proxies_[i].bounds.overlaps(proxies_[j].bounds)) return;
    found_.push_back(i < j ? ProxyPair{i, j} : ProxyPair{j, i});
  }

  static constexpr size_t most_pairs = size_t{1} << 25;  ///< per chunk: 256 MiB

  std::span<const BroadPhaseProxy> proxies_;
  std::span<const uint32_t> owners_;
  std::vector<ProxyPair> found_;
  std::vector<PairCollector> parts_;  ///< by chunk
  std::vector<uint32_t> ends_;
  BroadPhaseStats stats_;
};

}  // namespace tumble
