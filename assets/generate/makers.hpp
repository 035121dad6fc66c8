#pragma once
#include "assets/generate/mesh.hpp"

/// The functions that make the assets, by the file they live in.
namespace tumble::assets {

// furniture.cpp: the teapot stands on y = 0
Mesh make_chair();
Mesh make_teapot();

// hardware.cpp: centred on the origin
Mesh make_chain_link();
Mesh make_gear();
Mesh make_hex_bolt();
Mesh make_hex_nut();
Mesh make_i_beam();
Mesh make_l_bracket();
Mesh make_l_part();
Mesh make_ring();
Mesh make_stepped_shaft();
Mesh make_t_part();
Mesh make_torus_link();
Mesh make_washer();

// lock.cpp: the lock's axis is x, its front at x = 0; a key's shoulder is at x = 0
Mesh make_lock_case();
Mesh make_lock_key();
Mesh make_lock_key_wrong();
Mesh make_lock_plug();

// marble_run.cpp: y = 0 is the groove's bottom at the exit
Mesh make_marble_curve_left();
Mesh make_marble_curve_right();
Mesh make_marble_funnel();
Mesh make_marble_loop();
Mesh make_marble_ramp();
Mesh make_marble_spiral();
Mesh make_marble_straight();
Mesh make_marble_zigzag();

// masonry.cpp: stones of one arch
Mesh make_arch_keystone();
Mesh make_arch_springer();
Mesh make_arch_stone();

// ornaments.cpp
Mesh make_rook();
Mesh make_star_prism();
Mesh make_trefoil_knot();

// thin_walls.cpp
Mesh make_glass_case();
Mesh make_thin_dish();

// vessels.cpp: they stand on y = 0
Mesh make_bowl();
Mesh make_cup();
Mesh make_hourglass();
Mesh make_vase();

}  // namespace tumble::assets
