#pragma once
/// Do two simple shapes meet, and where? Yes or no is exact for the doubles given; touching is yes.
#include "engine/geometry/primitive_tests/box_pairs.hpp"
#include "engine/geometry/primitive_tests/sphere_pairs.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"
