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

}  // namespace tumble::lcp
