#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

std::string_view to_string(LcpStatus status) {
  switch (status) {
    case LcpStatus::solved:
      return "solved";
    case LcpStatus::infeasible:
      return "infeasible";
    case LcpStatus::ray:
      return "ray";
    case LcpStatus::not_semidefinite:
      return "not semi-definite";
    case LcpStatus::singular:
      return "singular";
    case LcpStatus::max_iterations:
      return "iteration limit";
    case LcpStatus::cycling:
      return "cycling";
    case LcpStatus::numeric:
      return "numeric";
  }
  return "unknown";
}

std::vector<Place> places_of(const LcpProblem& p, const VecX& z) {
  std::vector<Place> out;
  for (int i = 0; i < p.size(); ++i)
    out.push_back(z[i] <= p.lower[i]   ? Place::lower
                  : z[i] >= p.upper[i] ? Place::upper
                                       : Place::between);
  return out;
}

}  // namespace tumble::lcp
