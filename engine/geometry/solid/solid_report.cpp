#include "engine/geometry/solid/solid_report.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {

std::string_view to_string(SolidFaultKind kind) {
  switch (kind) {
    case SolidFaultKind::invalid:
      return "invalid";
    case SolidFaultKind::open_border:
      return "open_border";
    case SolidFaultKind::non_manifold_edge:
      return "non_manifold_edge";
    case SolidFaultKind::misoriented:
      return "misoriented";
    case SolidFaultKind::one_sided:
      return "one_sided";
    case SolidFaultKind::self_intersection:
      return "self_intersection";
    case SolidFaultKind::inside_out:
      return "inside_out";
    case SolidFaultKind::counted_twice:
      return "counted_twice";
    case SolidFaultKind::no_volume:
      return "no_volume";
    case SolidFaultKind::needle_fold:
      return "needle_fold";
    case SolidFaultKind::non_manifold_vertex:
      return "non_manifold_vertex";
    case SolidFaultKind::degenerate_triangle:
      return "degenerate_triangle";
    case SolidFaultKind::duplicate_triangle:
      return "duplicate_triangle";
    case SolidFaultKind::touching:
      return "touching";
  }
  return "";
}

bool SolidReport::solid() const {
  return std::none_of(faults.begin(), faults.end(),
                      [](const SolidFault& f) { return f.blocks_mass; });
}

const SolidFault* SolidReport::find(SolidFaultKind kind) const {
  for (const SolidFault& f : faults) {
    if (f.kind == kind) return &f;
  }
  return nullptr;
}

Status SolidReport::status() const {
  const SolidFault* first = nullptr;
  std::string others;
  for (const SolidFault& f : faults) {
    if (!f.blocks_mass) continue;
    if (!first) {
      first = &f;
    } else {
      others += fmt::format("{} {}", others.empty() ? "; also:" : ",", to_string(f.kind));
    }
  }
  if (!first) return {};
  std::string message = first->text + others;
  return Error{ErrorCode::invalid_argument, std::move(message), {}, first->cure};
}

std::string SolidReport::text() const {
  std::string out;
  for (const SolidFault& f : faults) {
    out += f.cure.empty() ? f.text + "\n" : fmt::format("{} ({})\n", f.text, f.cure);
  }
  return out;
}

}  // namespace tumble
