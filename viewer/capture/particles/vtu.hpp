#pragma once
#include "viewer/capture/particles/particle_sample.hpp"

#include <span>
#include <string>

namespace tumble {

/// Particles as an unstructured grid in VTK's XML format (.vtu, VTK file formats, version 1.0):
/// every particle is a point and a vertex cell; PointData are velocity [m/s], radius [m], mass
/// [kg], age [s] (Float64), id (UInt64) and colour (linear RGB, Float32). Arrays are inline in
/// base64, preceded by their length in bytes (UInt64), so that the whole file is valid XML. Values
/// are bitwise those of the world. The time [s] is a TimeValue of the FieldData.
std::string vtu_of(const ParticleSample& particles, double time);

/// One file of a collection.
struct PvdEntry {
  double time = 0;   ///< [s]
  std::string file;  ///< relative to the collection's folder
};
/// A collection (.pvd), which assigns times to files.
std::string pvd_of(std::span<const PvdEntry> entries);

/// Encodes as in RFC 4648, section 4.
std::string base64(std::string_view bytes);

}  // namespace tumble
