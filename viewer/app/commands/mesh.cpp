#include "engine/core/stop.hpp"
#include "engine/core/watched.hpp"
#include "viewer/app/command.hpp"
#include "viewer/app/commands/file_roles.hpp"
#include "viewer/app/drawing.hpp"
#include "viewer/app/mesh/mesh_picture.hpp"
#include "viewer/app/mesh/pieces_file.hpp"
#include "viewer/app/options.hpp"
#include "viewer/capture/progress.hpp"
#include "viewer/capture/stop_signal.hpp"
#include "viewer/render/overlays.hpp"

#include <charconv>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

namespace tumble {
namespace {

struct MeshLine {
  std::string file, up = "y", size = "1280x800";
  double scale = 1, density = 1;
  std::optional<double> weld;
  bool json = false;
  MeshPicture picture;
  std::string render;
  bool decompose = false, sdf = false, fit = false, representations = false;
  PiecesRequest pieces;
  FieldRequest field;
  std::string wrap;  ///< a gap or "auto"; empty: none
  WrapRequest wrapping;
};

constexpr std::string_view usual_gap = "auto";

/// Checks combinations of options.
Status check_line(MeshLine& line) {
  const auto bad = [](std::string text) {
    return Error{ErrorCode::invalid_argument, std::move(text), {}, {}};
  };
  // A range check accepts NaN.
  if (std::isnan(line.scale) || std::isnan(line.density) || std::isnan(line.weld.value_or(0)))
    return bad("--scale, --density and --weld must be numbers");
  if (!line.pieces.file.empty() && !line.decompose && line.wrap.empty())
    return bad("--out requires --decompose or --wrap");
  if (line.wrap.empty() || line.wrap == usual_gap) return {};
  const char* end = line.wrap.data() + line.wrap.size();
  const auto [rest, code] = std::from_chars(line.wrap.data(), end, line.wrapping.gap);
  if (code == std::errc() && rest == end && line.wrapping.gap >= 1e-9 && line.wrapping.gap <= 1e6)
    return {};
  return bad(
      fmt::format("--wrap={}: a gap of 1e-9 to 1e6 m, or {}, is wanted", line.wrap, usual_gap));
}

/// Replaces the mesh by its wrap if that is requested.
std::optional<int> add_wrap(const MeshLine& line, TriangleMesh& mesh,
                            std::optional<WrapFacts>& facts) {
  if (line.wrap.empty()) return std::nullopt;
  const StopSignal stop;
  auto made = wrap_in_place(mesh, line.wrapping, stop);
  if (stop.requested()) return stop.exit_code();
  if (!made)
    return report({made.error().code, made.error().message, line.file, made.error().cure},
                  exit_bad_input);
  facts = *std::move(made);
  if (line.decompose || line.pieces.file.empty()) return std::nullopt;
  if (Status s = write_mesh(line.pieces.file, mesh); !s)
    return report(s.error(), exit_cannot_write);
  facts->file = line.pieces.file;
  return std::nullopt;
}

/// Optional computations: pieces, distance field, primitives, comparison of all representations.
std::optional<int> add_parts(MeshLine& line, MeshFacts& facts) {
  if (!line.decompose && !line.sdf && !line.fit && !line.representations) return std::nullopt;
  const StopSignal stop;
  const auto answer = [&](const Error& error, bool cannot_write) {
    if (stop.requested()) return stop.exit_code();
    return report(
        {error.code, error.message, error.place.empty() ? line.file : error.place, error.cure},
        cannot_write ? exit_cannot_write : exit_bad_input);
  };
  if (line.decompose) {
    auto pieces = decompose_mesh(facts.mesh, line.pieces, stop);
    if (!pieces) return answer(pieces.error(), false);
    if (!line.pieces.file.empty()) {
      if (Status s = write_pieces(line.pieces.file, pieces->decomposition); !s)
        return report(s.error(), exit_cannot_write);
      pieces->file = line.pieces.file;
    }
    facts.pieces = *std::move(pieces);
  }
  if (line.sdf) {
    auto field = measure_field(facts.mesh, line.field, stop);
    if (const auto* fault = std::get_if<FieldFault>(&field))
      return answer(fault->error, fault->cannot_write);
    facts.field = std::get<FieldFacts>(std::move(field));
  }
  if (line.fit) {
    auto fit = fit_mesh(facts.mesh, stop);
    if (!fit) return answer(fit.error(), false);
    facts.fit = *std::move(fit);
  }
  if (line.representations) {
    const Stoppable scope(&stop.flag());
    MeshRepresentation base;
    base.concavity = line.pieces.concavity;
    base.pieces = uint32_t(line.pieces.most.value_or(0));
    base.cell = field_cell({.cell = line.field.cell, .error = line.field.error}, facts.box);
    facts.representations = measure_representations(facts.mesh, base);
    if (stop.requested()) return stop.exit_code();
  }
  return std::nullopt;
}

/// By when a mesh of a million triangles is read, of the time until its facts are there [-].
constexpr double share_of_import = 0.3;

/// Makes something, and shows its progress as that from one share of all work to another.
template <class F>
auto told(WorkProgress& progress, double from, double to, const F& make) {
  const ProgressSink show = [&](double share) { progress.show(from + (to - from) * share); };
  const Watched watched(&show);
  return make();
}

int run_mesh(MeshLine& line) {
  MeshPicture& picture = line.picture;
  if (Status s = parse_picture_size(line.size, picture.width, picture.height); !s)
    return report(s.error(), exit_usage);
  if (Status s = check_line(line); !s) return report(s.error(), exit_usage);
  if (Status s = check_context_name(picture.context); !s) return report(s.error(), exit_usage);
  const FileRoles files = FileRoles()
                              .reads(line.file)
                              .writes("--out", line.pieces.file)
                              .writes("--render", line.render)
                              .writes("--slices", line.field.slices);
  if (Status s = files.apart(); !s) return report(s.error(), exit_usage);
  ImportOptions options;
  options.scale = line.scale;
  options.weld = line.weld;
  options.up = line.up == "z" ? UpAxis::z : line.up == "x" ? UpAxis::x : UpAxis::y;
  WorkProgress progress("facts about the mesh");
  auto mesh = told(progress, 0, share_of_import, [&] { return import_mesh(line.file, options); });
  if (!mesh || !line.wrap.empty()) progress.finish();
  if (!mesh) return report(mesh.error(), exit_bad_input);
  std::optional<WrapFacts> wrap;
  if (const auto code = add_wrap(line, mesh->mesh, wrap)) return *code;
  MeshFacts facts = told(progress, share_of_import, 1,
                         [&] { return mesh_facts(line.file, *std::move(mesh), line.density); });
  progress.finish();
  facts.wrap = std::move(wrap);
  if (const auto code = add_parts(line, facts)) return *code;
  if (!line.render.empty()) {
    picture.file = line.render;
    if (const auto fault = draw_mesh_picture(facts, picture, stderr_log(LogLevel::warning)))
      return report(fault->error, fault->kind == PictureFailure::cannot_write ? exit_cannot_write
                                                                              : exit_no_renderer);
  }
  if (line.json) {
    fmt::print("{}\n", mesh_json(facts, line.render));
  } else {
    fmt::print("{}", mesh_text(facts));
    if (!line.render.empty()) fmt::print("  {:<16}{}\n", "picture", line.render);
  }
  return exit_ok;
}

void declare_wrap(Options& options, MeshLine& line) {
  const Option wrap = options.flag(
      "--wrap{auto}", line.wrap,
      "a closed surface about it in its place, for open or broken meshes; --wrap=GAP closes what a "
      "ball of this diameter does not pass [m], a 12th of the longest side unless given");
  options
      .value("--wrap-offset", line.wrapping.offset,
             "how far the wrap stands off the mesh [m]; a quarter of a cell unless given")
      .between(1e-9, 1e6)
      .needs(wrap);
  options
      .value(
          "--wrap-cell", line.wrapping.cell,
          "side of its cells [m]; a quarter of the gap, but from a 128th to a 40th of the longest "
          "side unless given")
      .between(1e-9, 1e6)
      .needs(wrap);
}

/// Declares the options of decomposition and distance field.
void declare_parts(Options& options, MeshLine& line) {
  const Option decompose =
      options.flag("--decompose", line.decompose, "cut it into convex pieces, for collision");
  const Option exact = options
                           .flag("--exact", line.pieces.exact,
                                 "pieces whose union is the mesh: cut at every reflex edge")
                           .needs(decompose);
  options
      .value("--flat", line.pieces.tolerance,
             "of exact pieces: faces that are flat within this are flat [m]")
      .between(0.0, 1e6)
      .needs(exact);
  options
      .value("--concavity", line.pieces.concavity,
             "pieces reach no farther outside the mesh [m]; a fiftieth of its diagonal unless "
             "given")
      .between(1e-9, 1e6)
      .needs(decompose)
      .excludes(exact);
  options
      .value("--pieces", line.pieces.most,
             "no more pieces than this; 64 unless given, exact ones 10000")
      .between(1, 10000)
      .needs(decompose);
  options
      .value("--out", line.pieces.file,
             "write the pieces, or else the wrap, into this OBJ (.obj) or glTF file (.glb, .gltf)")
      .not_empty()
      .ends_in(piece_file_endings());
  const Option sdf = options.flag("--sdf", line.sdf, "signed distance field: cost and error");
  const Option cell = options
                          .value("--cell", line.field.cell,
                                 "side of its cells [m]; a 64th of the longest side unless given")
                          .between(1e-9, 1e6)
                          .needs(sdf);
  options.value("--error", line.field.error, "instead: no point near the surface errs by more [m]")
      .between(1e-9, 1e6)
      .needs(sdf)
      .excludes(cell);
  options.flag("--fit", line.fit, "primitives that stand for it, the best first, and their errors");
  options.flag("--representations", line.representations,
               "what it may collide as, side by side: errors both ways, bytes, pieces, cost");
  const Option slices =
      options.value("--slices", line.field.slices, "draw slices of it into this folder as PNG")
          .not_empty()
          .needs(sdf);
  options.flag("--force", line.field.force, "overwrite slices that exist").needs(slices);
}

}  // namespace

CommandAction declare_mesh(Options& options) {
  auto line = std::make_shared<MeshLine>();
  options.value("file", line->file, "OBJ, STL, PLY, OFF, glTF, DAE and many more").required();
  options.value("--scale", line->scale, "metres per unit of the file")
      .between(1e-9, 1e9)
      .shows_default();
  options.value("--up", line->up, "axis of the file that points up")
      .one_of({"x", "y", "z"})
      .shows_default();
  options
      .value("--weld", line->weld,
             "vertices this near are one, and corners this near to a side lie on it [m]; a "
             "billionth of the size unless given")
      .between(0.0, 1e6);
  options.value("--density", line->density, "of mass and inertia [kg/m3]")
      .between(1e-9, 1e9)
      .shows_default();
  options.flag("--json", line->json, "one JSON object on stdout");
  const Option render = options
                            .value("--render", line->render,
                                   "draw it into this PNG file, which is replaced if it exists")
                            .not_empty();
  const Option kind =
      options.value("--hierarchy", line->picture.hierarchy, "volumes of this kind around it")
          .one_of(drawn_hierarchies())
          .needs(render);
  options.value("--level", line->picture.level, "of that hierarchy; 0 is the root")
      .between(0, 100)
      .shows_default()
      .needs(kind);
  options.value("--size", line->size, "width x height in pixels").shows_default().needs(render);
  options.value("--context", line->picture.context, "what draws: " + context_list())
      .shows_default()
      .needs(render);
  declare_wrap(options, *line);
  declare_parts(options, *line);
  options.footer(
      "Facts are those of the mesh after loading has cleaned it up; what that changed is listed.\n"
      "0 for everything that was loaded, closed or not; 3 for what cannot be. Lengths in metres,\n"
      "inertia about the centre of mass.\n\n"
      "Errors of what stands for it are Hausdorff distances of solids: `added` is how far it "
      "reaches\n"
      "outside the mesh, hollows included, `missing` how far the mesh stands out of it; as "
      "sampled.\n"
      "Pieces, fields and primitives are kept under $XDG_CACHE_HOME/tumble. A query is the "
      "contacts\n"
      "of a ball of a fiftieth of the size, laid about the surface. Numbers of --decompose and\n"
      "--sdf hold for --representations too.\n\n"
      "With --wrap all facts are those of the wrap, a closed surface with all of the mesh inside:\n"
      "`added` is how far it reaches outside the mesh as sampled and `bound` as proven, `missing` "
      "how\n"
      "far the mesh stands out of it, `buried` how far it lies beneath it.\n\n"
      "Of each hierarchy: root/hull, volume of the root's over the convex hull's; leaves/mesh,\n"
      "surface of all leaves' over the mesh's; nodes/line, volumes that a random line meets for\n"
      "each that meets the root's; less is better in all three. Build times are of this run.\n\n"
      "Keys of --json: file format vertices triangles edges parts[name triangles] shells[closed\n"
      "volume cavity triangles first_triangle] cavities closed solid open_edges\n"
      "non_manifold_edges misoriented_edges euler_characteristic holes[edges length centre\n"
      "vertices] faults[kind blocks_mass count edges vertices triangles pairs text cure]\n"
      "cleanup{changed welded_vertices unused_vertices split_triangles degenerate_triangles\n"
      "duplicate_triangles flipped_triangles flipped_parts} bounds{min max size} area volume "
      "centre\n"
      "inertia_per_density mass_properties{density mass centre inertia principal_moments\n"
      "principal_axes} no_volume_because hull{exists why vertices facets volume area\n"
      "volume_ratio} hierarchies{aabb obb sphere convex_hull: nodes leaves depth\n"
      "bytes bytes_per_triangle tightness{root_over_hull leaves_over_mesh nodes_per_line}\n"
      "timing{build_ms}} notes picture; null where there is no value. What was asked for, else no\n"
      "key: wrap{triangles_of_file gap offset cell added missing buried bound out "
      "timing{seconds}}\n"
      "decomposition{exact pieces[vertices faces volume added] cuts hull_volume mesh_volume\n"
      "volume_ratio added missing concavity bound_met left_out{parts volume} out timing{seconds}}\n"
      "distance_field{cell cells band blocks bits bytes bytes_per_area node_error band_error\n"
      "measured{rms largest} overlapped_nodes slices{folder count} timing{seconds}}\n"
      "fit{primitives[type, its sizes, position orientation added missing volume_ratio]\n"
      "timing{seconds}} representations{triangle_mesh convex_hull decomposition field fit: exists\n"
      "why what pieces bytes added missing volume_ratio timing{query_ns seconds}}\n\n"
      "Examples:\n"
      "  tumble mesh part.stl --scale 0.001 --up z\n"
      "  tumble mesh assets/meshes/gear.obj --json\n"
      "  tumble mesh assets/meshes/cup.obj --decompose --concavity 0.005 --out pieces.glb\n"
      "  tumble mesh assets/meshes/cup.obj --sdf --cell 0.002 --slices slices\n"
      "  tumble mesh scan.ply --wrap=0.02 --out closed.obj\n"
      "  tumble mesh assets/meshes/rook.obj --fit --representations\n"
      "  tumble mesh assets/meshes/vase.obj --render vase.png --hierarchy obb --level 4");
  return [line] { return run_mesh(*line); };
}

}  // namespace tumble
