#include "engine/scene/description/shape.hpp"
#include "viewer/app/mesh/mesh_facts.hpp"

#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

Json numbers_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json rows_json(const Mat3& m) {
  return {numbers_json(m.row(0).transpose()), numbers_json(m.row(1).transpose()),
          numbers_json(m.row(2).transpose())};
}

template <class T>
Json maybe_json(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json holes_json(const MeshFacts& f) {
  Json out = Json::array();
  for (const auto& loop : f.holes) {
    Vec3 middle = Vec3::Zero();
    double round = 0;
    for (size_t k = 0; k < loop.size(); ++k) {
      const Vec3& a = f.mesh->vertices[loop[k]];
      middle += a / double(loop.size());
      round += (f.mesh->vertices[loop[(k + 1) % loop.size()]] - a).norm();
    }
    out.push_back({{"edges", loop.size()},
                   {"length", round},
                   {"centre", numbers_json(middle)},
                   {"vertices", loop}});
  }
  return out;
}

Json cleanup_json(const CleanupReport& c) {
  return {{"changed", c.changed()},
          {"welded_vertices", c.welded_vertices},
          {"unused_vertices", c.unused_vertices},
          {"split_triangles", c.split_triangles},
          {"degenerate_triangles", c.degenerate_triangles},
          {"duplicate_triangles", c.duplicate_triangles},
          {"flipped_triangles", c.flipped_triangles},
          {"flipped_parts", c.flipped_parts}};
}

Json faults_json(const SolidReport& report) {
  Json out = Json::array();
  for (const SolidFault& fault : report.faults) {
    Json pairs = Json::array();
    for (const TriangleIds& p : fault.pairs) pairs.push_back({p.a, p.b});
    out.push_back({{"kind", to_string(fault.kind)},
                   {"blocks_mass", fault.blocks_mass},
                   {"count", fault.count},
                   {"edges", fault.edges},
                   {"vertices", fault.vertices},
                   {"triangles", fault.triangles},
                   {"pairs", pairs},
                   {"text", fault.text},
                   {"cure", fault.cure}});
  }
  return out;
}

Json shells_json(const SolidReport& report) {
  Json out = Json::array();
  for (const SolidShell& s : report.shells) {
    out.push_back({{"first_triangle", s.first_triangle},
                   {"triangles", s.triangles},
                   {"closed", s.closed},
                   {"volume", s.closed ? Json(s.volume) : Json(nullptr)},
                   {"cavity", s.cavity()}});
  }
  return out;
}

Json mass_json(const MeshFacts& f) {
  if (!f.mass) return nullptr;
  const MassProperties& m = *f.mass;
  Json axes = Json::array();
  for (int k = 0; k < 3; ++k) axes.push_back(numbers_json(f.principal.axes.col(k)));
  return {{"density", f.density},
          {"mass", m.mass},
          {"centre", numbers_json(m.centre)},
          {"inertia", rows_json(m.inertia)},
          {"principal_moments", numbers_json(f.principal.moments)},
          {"principal_axes", axes}};
}

Json hull_json(const MeshFacts& f) {
  if (!f.hull.missing.empty()) return {{"exists", false}, {"why", f.hull.missing}};
  Json out = {{"exists", true},          {"vertices", f.hull.vertices}, {"facets", f.hull.facets},
              {"volume", f.hull.volume}, {"area", f.hull.area},         {"volume_ratio", nullptr}};
  if (f.mass) out["volume_ratio"] = f.mass->mass / f.density / f.hull.volume;
  return out;
}

Json hierarchies_json(const std::vector<HierarchyFacts>& all) {
  Json out = Json::object();
  for (const HierarchyFacts& h : all) {
    out[h.kind] = {{"nodes", h.nodes},
                   {"leaves", h.leaves},
                   {"depth", h.depth},
                   {"bytes", h.bytes},
                   {"bytes_per_triangle", h.bytes_per_triangle},
                   {"tightness",
                    {{"root_over_hull", maybe_json(h.root_over_hull)},
                     {"leaves_over_mesh", maybe_json(h.leaves_over_mesh)},
                     {"nodes_per_line", h.nodes_per_line}}},
                   {"timing", {{"build_ms", h.build_ms}}}};
  }
  return out;
}

Json wrap_json(const WrapFacts& f) {
  const WrapReport& r = f.report;
  Json out = {{"triangles_of_file", f.triangles},
              {"gap", r.gap},
              {"offset", r.offset},
              {"cell", r.cell},
              {"added", r.added},
              {"missing", r.missing},
              {"buried", r.buried},
              {"nearest", r.nearest},
              {"bound", r.bound},
              {"timing", {{"seconds", f.seconds}}}};
  if (!f.file.empty()) out["out"] = f.file.string();
  return out;
}

Json pieces_json(const PiecesFacts& f) {
  const ConvexDecomposition& d = f.decomposition;
  Json pieces = Json::array();
  for (const ConvexPiece& p : d.pieces)
    pieces.push_back({{"vertices", p.hull.vertices.size()},
                      {"faces", p.hull.face_count()},
                      {"volume", p.volume},
                      {"added", p.added}});
  Json out = {{"exact", d.exact},
              {"pieces", pieces},
              {"cuts", d.cuts},
              {"hull_volume", d.hull_volume},
              {"mesh_volume", d.mesh_volume},
              {"volume_ratio", d.hull_volume / d.mesh_volume},
              {"added", d.added},
              {"missing", d.missing},
              {"concavity", d.exact ? Json(nullptr) : Json(d.concavity)},
              {"bound_met", d.bound_met},
              {"timing", {{"seconds", f.seconds}}}};
  if (d.exact) out["left_out"] = {{"parts", d.left_out}, {"volume", d.left_out_volume}};
  if (!f.file.empty()) out["out"] = f.file.string();
  return out;
}

Json field_json(const FieldFacts& f) {
  Json out = {{"cell", f.cell},
              {"cells", f.cells},
              {"band", f.band},
              {"blocks", f.report.blocks},
              {"bits", f.report.bits},
              {"bytes", f.report.bytes},
              {"bytes_per_area", f.report.bytes_per_area},
              {"node_error", f.report.node_error},
              {"band_error", f.report.band_error},
              {"measured", {{"rms", f.measured.rms}, {"largest", f.measured.largest}}},
              {"overlapped_nodes", f.report.overlapped_nodes},
              {"timing", {{"seconds", f.seconds}}}};
  if (f.slices > 0) out["slices"] = {{"folder", f.folder.string()}, {"count", f.slices}};
  return out;
}

Json fit_json(const FitFacts& facts) {
  Json out = Json::array();
  for (const FittedPrimitive& fit : facts.fits) {
    Json one = {{"type", shape_entry(fit.shape.type).name}};
    for (const ShapeParameter& p : shape_entry(fit.shape.type).parameters) {
      if (p.number) one[std::string(p.parameter.name)] = fit.shape.*p.number / p.factor;
      if (p.vector)
        one[std::string(p.parameter.name)] = numbers_json(fit.shape.*p.vector / p.factor);
    }
    const Quat& q = fit.pose.q;
    one["position"] = numbers_json(fit.pose.x);
    one["orientation"] = {q.w(), q.x(), q.y(), q.z()};
    one["added"] = fit.error.added;
    one["missing"] = fit.error.missing;
    one["volume_ratio"] = fit.mesh_volume > 0 ? Json(fit.volume / fit.mesh_volume) : Json(nullptr);
    out.push_back(std::move(one));
  }
  return {{"primitives", out}, {"timing", {{"seconds", facts.seconds}}}};
}

Json representations_json(const std::vector<RepresentationFacts>& all) {
  Json out = Json::object();
  for (const RepresentationFacts& f : all) {
    Json& one = out[std::string(enum_name(f.mode))];
    if (!f.refusal.empty()) {
      one = {{"exists", false}, {"why", f.refusal}};
      continue;
    }
    one = {{"exists", true},
           {"what", f.words},
           {"pieces", f.parts.parts.size()},
           {"bytes", f.bytes},
           {"added", f.error.added},
           {"missing", f.error.missing},
           {"volume_ratio", f.volume_ratio > 0 ? Json(f.volume_ratio) : Json(nullptr)},
           {"timing", {{"query_ns", f.query_ns}, {"seconds", f.seconds}}}};
  }
  return out;
}

}  // namespace

std::string mesh_json(const MeshFacts& f, const std::string& picture) {
  const MeshTopology& t = f.topology;
  Json parts = Json::array();
  for (const ImportedPart& p : f.parts)
    parts.push_back({{"name", p.name}, {"triangles", p.triangles}});
  Json out = {
      {"file", f.file},
      {"format", f.format},
      {"vertices", f.mesh->vertices.size()},
      {"triangles", f.mesh->triangles.size()},
      {"edges", t.edges.size()},
      {"parts", parts},
      {"shells", shells_json(f.solid)},
      {"cavities", f.solid.cavities},
      {"closed", t.closed_and_oriented()},
      {"solid", f.solid.solid()},
      {"open_edges", t.open_edges},
      {"non_manifold_edges", t.non_manifold_edges},
      {"misoriented_edges", t.misoriented_edges},
      {"euler_characteristic", t.euler_characteristic},
      {"holes", holes_json(f)},
      {"faults", faults_json(f.solid)},
      {"cleanup", cleanup_json(f.cleanup)},
      {"bounds",
       {{"min", numbers_json(f.box.min)},
        {"max", numbers_json(f.box.max)},
        {"size", numbers_json(f.box.extent())}}},
      {"area", f.area},
      {"volume", f.mass ? Json(f.mass->mass / f.density) : Json(nullptr)},
      {"centre", f.mass ? numbers_json(f.mass->centre) : Json(nullptr)},
      {"inertia_per_density", f.mass ? rows_json(f.mass->inertia / f.density) : Json(nullptr)},
      {"mass_properties", mass_json(f)},
      {"no_volume_because", f.mass ? Json(nullptr) : Json(f.mass.error().text())},
      {"hull", hull_json(f)},
      {"hierarchies", hierarchies_json(f.hierarchies)},
      {"notes", f.notes}};
  if (f.wrap) out["wrap"] = wrap_json(*f.wrap);
  if (f.pieces) out["decomposition"] = pieces_json(*f.pieces);
  if (f.field) out["distance_field"] = field_json(*f.field);
  if (f.fit) out["fit"] = fit_json(*f.fit);
  if (!f.representations.empty()) out["representations"] = representations_json(f.representations);
  if (!picture.empty()) out["picture"] = picture;
  return out.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tumble
