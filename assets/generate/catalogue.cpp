#include "assets/generate/catalogue.hpp"

#include "assets/generate/audit.hpp"
#include "assets/generate/makers.hpp"
#include "assets/generate/obj.hpp"
#include "assets/generate/off.hpp"

#include <fmt/format.h>

namespace tumble::assets {

const std::vector<Asset>& all_assets() {
  static const std::vector<Asset> assets = {
      {"arch_keystone", "wedge as arch_stone, outer radius 2.15", make_arch_keystone, true},
      {"arch_springer", "block under an arch's end; origin in the middle of its top",
       make_arch_springer, true},
      {"arch_stone", "wedge, 1 of 13 of a half circle, radii 1.5 and 2.0; y outward, z along axis",
       make_arch_stone, true},
      {"bowl", "bowl on a foot ring; axis y, stands on y = 0", make_bowl},
      {"chain_link", "oval link in the xy plane, long axis y, wire radius 0.045", make_chain_link},
      {"chair", "four legs, seat 0.44 x 0.44, back; the back is at -z", make_chair},
      {"cup", "tumbler; axis y, stands on y = 0", make_cup},
      {"gear", "16 involute teeth, module 0.03, bore radius 0.07; axis y", make_gear},
      {"glass_case",
       "closed case, inside 1.2 x 0.8 x 0.7, walls of 6 mm; floor at y = 0, a pinhole of 1 mm "
       "above",
       make_glass_case},
      {"hex_bolt", "0.20 across flats, shank radius 0.06; axis y, head up", make_hex_bolt},
      {"hex_nut", "0.20 across flats, hole radius 0.065; axis y", make_hex_nut},
      {"hourglass", "glass of an hourglass, open at both ends, waist of radius 0.06; axis y",
       make_hourglass},
      {"i_beam", "I section 0.30 x 0.40, 4 m long; along x, web upright", make_i_beam},
      {"l_bracket", "angle with four holes of radius 0.065; legs along x and y", make_l_bracket},
      {"l_part", "feeder part, flat L with a hole; thickness along y", make_l_part},
      {"lock_case", "pin tumbler lock without plug and pins; axis x, open at -x and +x",
       make_lock_case},
      {"lock_key", "its key, lying flat; along x, teeth at -z, thickness along y", make_lock_key},
      {"lock_key_wrong", "a key whose teeth are not those of the lock", make_lock_key_wrong},
      {"lock_plug", "what turns in lock_case; axis x, four square holes for pins at +y",
       make_lock_plug},
      {"marble_curve_left", "quarter turn to the left; enters heading +x at the origin's column",
       make_marble_curve_left},
      {"marble_curve_right", "quarter turn to the right; enters heading +x at the origin's column",
       make_marble_curve_right},
      {"marble_funnel", "gravity well; axis y, spout ends at y = 0", make_marble_funnel},
      {"marble_loop", "chute from 1.2 m into a loop-the-loop of radius 0.30, along x",
       make_marble_loop},
      {"marble_ramp", "sloping channel with a catching scoop; runs towards +x", make_marble_ramp},
      {"marble_spiral", "three turns of radius 0.6 about y, to the left", make_marble_spiral},
      {"marble_straight", "straight channel, 1 m along +x, falling 0.1", make_marble_straight},
      {"marble_zigzag", "four straights and three banked turns, spread along z",
       make_marble_zigzag},
      {"ring", "flat ring, radii 0.20 and 0.26; axis y", make_ring},
      {"rook", "chess piece with six merlons; axis y, stands on y = 0", make_rook},
      {"star_prism", "five-pointed star; thickness along y", make_star_prism},
      {"stepped_shaft", "feeder part, turned in four diameters; axis y", make_stepped_shaft},
      {"t_part", "feeder part, flat T with a hole; thickness along y", make_t_part},
      {"teapot", "hollow pot with a solid spout along +x and a handle; axis y, stands on y = 0",
       make_teapot},
      {"thin_dish", "dish of 0.1 mm, part of a sphere of radius 1.1; axis y, bulging up",
       make_thin_dish},
      {"torus_link", "round link, radii 0.20 and 0.045 (32 x 14); axis y", make_torus_link},
      {"trefoil_knot", "knotted tube of radius 0.055, flat in xz", make_trefoil_knot},
      {"vase", "bellied vase; axis y, stands on y = 0", make_vase},
      {"washer", "feeder part, radii 0.065 and 0.13; axis y", make_washer},
  };
  return assets;
}

std::string file_name(const Asset& asset) {
  return fmt::format("{}.{}", asset.name, asset.exact ? "off" : "obj");
}

std::string file_text(const Asset& asset, const Mesh& mesh) {
  return asset.exact ? off_text(asset.name, mesh) : obj_text(asset.name, mesh);
}

std::string table_row(const Asset& asset) {
  const Mesh mesh = asset.make();
  const Audit report = audit(mesh);
  const Vec3 size = report.high - report.low;
  return fmt::format("| `{}` | {:.3f} x {:.3f} x {:.3f} | {} | {:.6f} | {} |", file_name(asset),
                     size.x(), size.y(), size.z(), mesh.triangles.size(), report.volume,
                     asset.what);
}

}  // namespace tumble::assets
