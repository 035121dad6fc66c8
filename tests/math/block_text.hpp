#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"

#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

/// Problems in files of text, after what a simulation met (the purpose of the FCLIB collection,
/// Acary, Brémond, Huber 2014, whose own files need HDF5). Lines:
///   tumble_block_problem BLOCKS UNKNOWNS GROUPS
///   row B BLOCK0 x6 BLOCK1 x6            one per unknown; block -1 has no entries
///   cone AXIAL LATERAL0 LATERAL1 SLOPE undecided|sliding DIRECTION0 DIRECTION1
/// Axial unknowns are at least 0, all others free.
namespace tumble::lcp_text {

inline void write(const lcp::BlockProblem& p, const std::string& file) {
  std::FILE* f = std::fopen(file.c_str(), "w");
  if (!f) return;
  std::fprintf(f, "tumble_block_problem %d %d %d\n", p.blocks, p.size(),
               int(p.conditions.groups.size()));
  for (int i = 0; i < p.size(); ++i) {
    const lcp::BlockRow& row = p.rows[size_t(i)];
    std::fprintf(f, "row %.17g", p.conditions.b[i]);
    for (size_t s = 0; s < 2; ++s) {
      std::fprintf(f, " %d", row.block[s]);
      for (size_t k = 0; k < 6 && row.block[s] >= 0; ++k)
        std::fprintf(f, " %.17g", row.entries[s][k]);
    }
    std::fprintf(f, "\n");
  }
  for (const lcp::ConeGroup& g : p.conditions.groups)
    std::fprintf(f, "cone %d %d %d %.17g %s %.17g %.17g\n", g.axial, g.lateral[0], g.lateral[1],
                 g.slope, g.mode == lcp::ConeMode::sliding ? "sliding" : "undecided",
                 g.direction[0], g.direction[1]);
  std::fclose(f);
}

/// Empty when there is no such file, or when it is another.
inline lcp::BlockProblem read(const std::string& file) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  lcp::BlockProblem p;
  std::ifstream in(file);
  std::string word;
  int unknowns = 0, groups = 0;
  if (!(in >> word >> p.blocks >> unknowns >> groups) || word != "tumble_block_problem") return {};
  p.conditions.b = lcp::VecX::Zero(unknowns);
  p.conditions.lower = lcp::VecX::Constant(unknowns, -inf);
  p.conditions.upper = lcp::VecX::Constant(unknowns, inf);
  for (int i = 0; i < unknowns; ++i) {
    lcp::BlockRow& row = p.rows.emplace_back();
    in >> word >> p.conditions.b[i];
    for (size_t s = 0; s < 2; ++s) {
      in >> row.block[s];
      for (size_t k = 0; k < 6 && row.block[s] >= 0; ++k) in >> row.entries[s][k];
    }
  }
  for (int i = 0; i < groups; ++i) {
    lcp::ConeGroup& g = p.conditions.groups.emplace_back();
    std::string mode;
    in >> word >> g.axial >> g.lateral[0] >> g.lateral[1] >> g.slope >> mode >> g.direction[0] >>
        g.direction[1];
    if (mode == "sliding") g.mode = lcp::ConeMode::sliding;
    if (g.axial >= 0 && g.axial < unknowns) p.conditions.lower[g.axial] = 0;
  }
  if (!in) return {};
  return p;
}

}  // namespace tumble::lcp_text
