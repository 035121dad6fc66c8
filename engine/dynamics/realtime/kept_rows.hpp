#pragma once
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cstdint>

namespace tumble {

// Rows that are solved at once: first the kept rows (constraints), then rows with force laws, which
// must respect the constraints. k(i, j) accesses the lower triangle of K = J M^-1 J^T of `n` rows,
// of which the first `kept` are kept.

/// Replaces K by L D L^T: L below the diagonal, on it 1/D for kept rows (0 for a row that depends
/// linearly on those before; it gets no impulse). The block of the other rows becomes their Schur
/// complement, the compliance under the constraints. `scaled` has room for a row.
template <class Matrix, class Room>
void factorise_kept(const Matrix& k, uint32_t kept, uint32_t n, Room& scaled) {
  const auto divide = [&](uint32_t j, uint32_t columns) {
    for (uint32_t m = 0; m < columns; ++m) {
      scaled[m] = k(j, m);  // L D
      k(j, m) *= k(m, m);
    }
  };
  const auto is_left = [](double d, double diagonal) {
    return d > tolerances::dependent_row * diagonal;
  };
  for (uint32_t j = 0; j < kept; ++j) {
    const double diagonal = k(j, j);
    divide(j, j);
    double d = diagonal;
    for (uint32_t m = 0; m < j; ++m) d -= scaled[m] * k(j, m);
    k(j, j) = is_left(d, diagonal) ? 1 / d : 0;
    for (uint32_t i = j + 1; i < n; ++i) {
      for (uint32_t m = 0; m < j; ++m) k(i, j) -= k(i, m) * k(j, m);
    }
  }
  for (uint32_t j = kept; j < n; ++j) {
    const double diagonal = k(j, j);
    divide(j, kept);
    for (uint32_t i = kept; i <= j; ++i)
      for (uint32_t m = 0; m < kept; ++m) k(j, i) -= scaled[m] * k(i, m);
    if (!is_left(k(j, j), diagonal)) k(j, j) = 0;
  }
}

// A soft kept row removes only 1 - `give` of its velocity, and `give` of its impulse so far
// (Softness::impulse_scale), as if K were larger by give / (1 - give) of itself among the kept
// rows. The remaining velocity affects the other rows and must be taken into account there: the
// sweeps then solve one and the same system block by block, and converge.

/// Once after factorise_kept: the compliance of the other rows under soft kept rows.
template <class Matrix>
void soften_kept(const Matrix& k, uint32_t kept, uint32_t n, double give) {
  for (uint32_t j = kept; j < n; ++j)
    for (uint32_t i = kept; i <= j; ++i)
      for (uint32_t m = 0; m < kept; ++m)
        if (k(m, m) > 0) k(j, i) += give * k(j, m) * k(i, m) / k(m, m);
}

/// After eliminate_kept: corrects the velocities of the other rows for the softness of the kept
/// rows. impulse(i) is the impulse of a kept row so far.
template <class Matrix, class Values, class Impulse>
void leave_of_soft(const Matrix& k, uint32_t kept, uint32_t n, double give, const Impulse& impulse,
                   Values& x) {
  for (uint32_t m = 0; m < kept; ++m) {
    if (!(k(m, m) > 0)) continue;
    double own = impulse(m);
    for (uint32_t i = m + 1; i < kept; ++i) own += k(i, m) * impulse(i);
    const double left = give * (x[m] - own / k(m, m));
    for (uint32_t j = kept; j < n; ++j) x[j] += k(j, m) * left;
  }
}

/// x = L^-1 x (forward substitution): velocities of the other rows with the kept rows solved.
template <class Matrix, class Values>
void eliminate_kept(const Matrix& k, uint32_t kept, uint32_t n, Values& x) {
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t m = 0; m < std::min(i, kept); ++m) x[i] -= k(i, m) * x[m];
}

/// Backward substitution: from eliminated velocities and changes of the other impulses to the
/// changes of kept impulses, all negative.
template <class Matrix, class Values>
void substitute_kept(const Matrix& k, uint32_t kept, uint32_t n, Values& x) {
  for (uint32_t i = 0; i < kept; ++i) x[i] *= k(i, i);
  for (uint32_t i = kept; i-- > 0;)
    for (uint32_t m = i + 1; m < n; ++m) x[i] -= k(m, i) * x[m];
}

/// Solves the rows of force laws one after the other, in a few sweeps: from eliminated velocities
/// to negative changes of impulses. law(i, free) is the impulse of row i given the velocity without
/// it (DriveRow::solve); impulse(i) is its impulse so far.
template <class Matrix, class Values, class Law, class Impulse>
void solve_laws(const Matrix& k, uint32_t kept, uint32_t n, const Law& law, const Impulse& impulse,
                Values& change, Values& x) {
  const auto compliance = [&](uint32_t i, uint32_t j) { return i < j ? k(j, i) : k(i, j); };
  for (uint32_t i = kept; i < n; ++i) change[i] = 0;
  const int sweeps = n - kept > 1 ? tolerances::drive_sweeps : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (uint32_t i = kept; i < n; ++i) {
      double free = x[i] - compliance(i, i) * impulse(i);
      for (uint32_t j = kept; j < n; ++j)
        if (j != i) free += compliance(i, j) * change[j];
      change[i] = law(i, free) - impulse(i);
    }
  for (uint32_t i = kept; i < n; ++i) x[i] = -change[i];
}

}  // namespace tumble
