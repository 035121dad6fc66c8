// Fifteen lines that drop a ball: free fall for one second, to the integrator's accuracy.
#include "engine/world/world.hpp"

#include <cstdio>

int main() {
  auto world = tumble::World::create();
  if (!world) return 1;
  tumble::BodyDef ball;
  ball.pose.x = {0, 100, 0};
  ball.shapes.emplace_back();  // a sphere of radius 0.5 m
  if (!(*world)->create_body(ball)) return 2;
  for (int i = 0; i < 60; ++i)
    if (!(*world)->step()) return 3;
  const double y = (*world)->frame()->body(0).pose.x.y();
  std::printf("%.3f\n", y);
  return y > 94.9 && y < 95.2 ? 0 : 4;
}
