#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"

namespace tumble::lcp {

/// The problem with A = G G^T as a matrix, by a full G.
inline LcpProblem with_matrix(const BlockProblem& p) {
  MatX G = MatX::Zero(p.size(), 6 * p.blocks);
  for (int i = 0; i < p.size(); ++i)
    for (size_t s = 0; s < 2; ++s)
      for (int k = 0; k < 6 && p.rows[size_t(i)].block[s] >= 0; ++k)
        G(i, 6 * p.rows[size_t(i)].block[s] + k) = p.rows[size_t(i)].entries[s][size_t(k)];
  LcpProblem out = p.conditions;
  out.A = G * G.transpose();
  return out;
}

}  // namespace tumble::lcp
