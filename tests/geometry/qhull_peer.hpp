#pragma once
#include "engine/math/types.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

/// Qhull through its reentrant C library (its C++ headers do not compile as C++20).
namespace tumble::peers {

struct QhullAnswer {
  bool ok = false;
  std::vector<uint32_t> vertices;  ///< input points that it keeps, ascending
  double volume = 0;
};

/// Qhull of `points`; `options` as for the program, "Qt" for triangles, "Pp" for no warnings.
inline QhullAnswer qhull(const std::vector<Vec3>& points, const char* options = "Pp",
                         bool measure = true) {
  QhullAnswer out;
  qhT state;
  qh_zero(&state, stderr);
  std::FILE* quiet = std::fopen("/dev/null", "w");
  std::string command = std::string("qhull ") + options;
  auto* coordinates = const_cast<double*>(points.data()->data());  // not written to without QR, QJ
  out.ok = qh_new_qhull(&state, 3, int(points.size()), coordinates, False, command.data(), nullptr,
                        quiet) == 0;
  if (out.ok && measure) {
    qh_getarea(&state, state.facet_list);
    out.volume = state.totvol;
  }
  if (out.ok) {
    for (const vertexT* v = state.vertex_list; v && v->next; v = v->next) {
      out.vertices.push_back(uint32_t(qh_pointid(&state, v->point)));
    }
    std::sort(out.vertices.begin(), out.vertices.end());
  }
  int left = 0, bytes = 0;
  qh_freeqhull(&state, !qh_ALL);
  qh_memfreeshort(&state, &left, &bytes);
  if (quiet) std::fclose(quiet);
  return out;
}

}  // namespace tumble::peers
