#pragma once
#include "engine/math/lcp/problem.hpp"

namespace tumble::lcp {

/// Orthonormal columns that span the rows of A: z and z' have the same A z if they have the same
/// products with all columns. The rank is decided on the scaled matrix, in which the remainder of a
/// row must exceed 1e-10 (Gram-Schmidt applied twice, the longest remaining row next).
MatX row_space(const LcpProblem& problem);

}  // namespace tumble::lcp
