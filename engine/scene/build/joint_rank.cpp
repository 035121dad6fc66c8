#include "engine/scene/build/joint_rank.hpp"

#include "engine/dynamics/joints/articulation.hpp"
#include "engine/scene/build/jointed_bodies.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace tumble {
JointRank joint_rank(const BuiltScene& built) {
  JointRank out;
  if (built.joints.empty()) return out;
  const JointedBodies held(built);
  const std::vector<uint32_t> slots = first_numbers(held.bodies.size()),
                              joints = first_numbers(held.joints.size()),
                              couplings = first_numbers(held.couplings.size());
  Articulation rows({held.joints, held.couplings}, {joints, couplings}, held.block_of, held.bodies,
                    held.bodies.size());
  rows.update(held.bodies, blocks_of(held.bodies, slots));
  std::map<uint32_t, size_t> dependent;  // number of dependent rows by joint
  for (size_t i = 0; i < rows.size(); ++i) {
    const HeldRow& row = rows.held()[i];
    if (row.use == RowUse::armature) continue;
    ++out.rows;
    if (!rows.depends(i))
      ++out.rank;
    else
      ++dependent[row.use == RowUse::coupling ? held.couplings[row.owner].a : row.owner];
  }
  for (const auto& [joint, count] : dependent) out.dependent.emplace_back(held.names[joint], count);
  return out;
}

std::string text_of(const JointRank& rank) {
  constexpr size_t most = 5;
  if (rank.rows == 0) return {};
  std::string out = fmt::format("joint rows: {}, rank {}", rank.rows, rank.rank);
  for (size_t i = 0; i < std::min(most, rank.dependent.size()); ++i)
    out += fmt::format("{} {} of '{}'", i == 0 ? ", dependent:" : ",", rank.dependent[i].second,
                       rank.dependent[i].first);
  if (rank.dependent.size() > most)
    out += fmt::format(" and those of {} more", rank.dependent.size() - most);
  return out;
}

}  // namespace tumble
