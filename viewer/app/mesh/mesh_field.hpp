#pragma once
#include "engine/geometry/distance_field/distance_field.hpp"

#include <filesystem>
#include <string>
#include <variant>

namespace tumble {

class StopSignal;

/// Options of `tumble mesh --sdf`.
struct FieldRequest {
  double cell = 0, error = 0;  ///< as in DistanceFieldOptions [m]
  std::string slices;          ///< folder for pictures; empty: none
  bool force = false;          ///< overwrite existing pictures
};

/// The distance field of a mesh and its cost.
struct FieldFacts {
  double cell = 0, band = 0;  ///< [m]
  std::array<int, 3> cells{};
  FieldReport report;
  FieldError measured;
  double seconds = 0;
  size_t slices = 0;  ///< pictures written
  std::filesystem::path folder;
};

/// Why there is no field.
struct FieldFault {
  Error error;
  bool cannot_write = false;
};

/// Builds the field with progress on stderr, or takes it from the cache; measures it, and writes
/// slices as PNG: slice_000.png at the lowest z and so on, x to the right and y up. Inside blue,
/// outside orange, a line at the surface and at every two cells of distance, paler beyond the band.
/// Each file appears whole or not at all; after a signal no further one is begun and the fault is
/// `cancelled`.
std::variant<FieldFacts, FieldFault> measure_field(const std::shared_ptr<const TriangleMesh>& mesh,
                                                   const FieldRequest& request,
                                                   const StopSignal& stop);

std::string field_text(const FieldFacts& facts);

}  // namespace tumble
