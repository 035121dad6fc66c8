#pragma once
#include "viewer/capture/particles/particle_sample.hpp"

#include <span>
#include <string>

namespace tumble {

/// Particles as an unstructured grid of VTK's XML formats (.vtu, VTK file formats, version 1.0):
/// every particle a point and a vertex cell; PointData velocity [m/s], radius [m], mass [kg], age
/// [s] (Float64), id (UInt64) and colour (linear RGB, Float32). Arrays stand inline in base64,
/// behind their length in bytes (UInt64), so that the file is XML as a whole. Values are the
/// world's own bits. The time is a TimeValue of the FieldData.
std::string vtu_of(const ParticleSample& particles, double time);

/// One file of a collection.
struct PvdEntry {
  double time = 0;   ///< [s]
  std::string file;  ///< relative to the collection's folder
};
/// A collection (.pvd): which file is which moment.
std::string pvd_of(std::span<const PvdEntry> entries);

/// RFC 4648, section 4.
std::string base64(std::string_view bytes);

}  // namespace tumble
