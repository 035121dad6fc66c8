#pragma once
#include "engine/math/types.hpp"

/// Linear colours of overlays; the legend (overlays.cpp) explains them.
namespace tumble::overlay_colour {

inline const Vec4f contact(1.0f, 0.85f, 0.1f, 1), overlap(1.0f, 0.1f, 0.05f, 1);
inline const Vec4f normal(0.1f, 0.8f, 1.0f, 1);
inline const Vec4f force(0.95f, 0.2f, 0.05f, 1);
inline const Vec4f flow(0.15f, 0.75f, 0.95f, 0.75f), pull(1.0f, 0.5f, 0.1f, 0.75f);
inline const Vec4f sticks(0.05f, 0.65f, 0.2f, 0.9f), slides(1.0f, 0.2f, 0.02f, 0.9f);
inline const Vec4f bounds(0.2f, 0.9f, 0.3f, 0.8f);
inline const Vec4f anchor(1.0f, 0.45f, 0.1f, 1);
inline const Vec4f axes[] = {{0.95f, 0.2f, 0.15f, 1}, {0.2f, 0.8f, 0.25f, 1}, {0.2f, 0.45f, 1, 1}};
inline const Vec4f velocity(0.1f, 0.45f, 1.0f, 1);
inline const Vec4f momentum(0.75f, 0.12f, 0.85f, 1), total_force(1.0f, 0.62f, 0.02f, 1);
inline const Vec4f sensor(0.55f, 0.6f, 0.66f, 0.9f), sensing(0.2f, 0.9f, 0.45f, 1);
inline const Vec4f wire(0.05f, 0.9f, 0.9f, 0.7f);

}  // namespace tumble::overlay_colour
