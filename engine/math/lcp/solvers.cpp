#include "engine/math/lcp/solvers.hpp"

#include "engine/math/lcp/interior/cone_interior.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/pivoting/baraff.hpp"
#include "engine/math/lcp/pivoting/dantzig.hpp"
#include "engine/math/lcp/pivoting/enumeration.hpp"
#include "engine/math/lcp/pivoting/lemke.hpp"
#include "engine/math/lcp/sweep/pgs.hpp"

namespace tumble::lcp {

const std::vector<LcpSolverEntry>& all_lcp_solvers() {
  static const std::vector<LcpSolverEntry> list{
      {"dantzig", false, false, false, true, dantzig},
      {"baraff", false, true, true, true, baraff},
      {"lemke", true, false, true, true, lemke},
      {"pgs", true, true, true, false, pgs},
      {"cone_newton", true, true, true, false, cone_newton},
      {"cone_interior", true, true, true, false, cone_interior},
      {"enumeration", true, false, true, true, enumeration},
  };
  return list;
}

}  // namespace tumble::lcp
