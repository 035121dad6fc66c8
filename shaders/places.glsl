// Where a point of the world is in the maps that shade it.
vec3 in_shadow_map(vec3 world, vec3 n) {
  return (shadow_from_world * vec4(world + n * shadow_look.y, 1.0)).xyz;
}
vec2 in_contact_map(vec3 world) { return (world.xz - contact.xy) * contact.zw; }
float lowness(float height) { return 1.0 - (height - ground.x) * contact_look.x; }
