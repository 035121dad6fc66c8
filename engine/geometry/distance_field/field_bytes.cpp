#include "engine/geometry/distance_field/distance_field.hpp"

namespace tumble {
namespace {

constexpr int most_blocks = 1 << 20;  ///< greatest number of blocks along an axis in a valid file

/// Reading and writing use the same list of members, so that they agree.
template <class Stream, class Report>
void visit_report(Stream& stream, Report& r) {
  stream(r.bytes_per_area);
  stream(r.bits);
  stream(r.node_error);
  stream(r.band_error);
}

}  // namespace

void DistanceField::write(ByteWriter& out) const {
  out.value(layout_.origin);
  out.value(layout_.cell);
  for (const int n : layout_.blocks) out.value(n);
  for (const double x : {inverse_cell_, band_, node_range_, step_}) out.value(x);
  out.value(mesh_box_.min);
  out.value(mesh_box_.max);
  out.vector(block_of_);
  out.vector(short_values_);
  out.vector(long_values_);
  out.vector(corners_);
  for (const size_t n : {report_.blocks, report_.bytes, report_.nodes, report_.overlapped_nodes})
    out.value(uint64_t{n});
  const auto write_value = [&out](const auto& x) { out.value(x); };
  visit_report(write_value, report_);
}

std::optional<DistanceField> DistanceField::read(ByteReader& in) {
  DistanceField f;
  in.value(f.layout_.origin);
  in.value(f.layout_.cell);
  for (int& n : f.layout_.blocks) in.value(n);
  for (double* x : {&f.inverse_cell_, &f.band_, &f.node_range_, &f.step_}) in.value(*x);
  in.value(f.mesh_box_.min);
  in.value(f.mesh_box_.max);
  in.vector(f.block_of_);
  in.vector(f.short_values_);
  in.vector(f.long_values_);
  in.vector(f.corners_);
  for (size_t* n :
       {&f.report_.blocks, &f.report_.bytes, &f.report_.nodes, &f.report_.overlapped_nodes})
    *n = size_t(in.get<uint64_t>());
  const auto read_value = [&in](auto& x) { in.value(x); };
  visit_report(read_value, f.report_);
  // Checks that all sizes agree, so that no query reads out of range.
  if (!in.ok() || !(f.layout_.cell > 0)) return std::nullopt;
  for (const int n : f.layout_.blocks)
    if (n < 1 || n > most_blocks) return std::nullopt;
  const size_t values = std::max(f.short_values_.size(), f.long_values_.size());
  if (f.short_values_.size() != 0 && f.long_values_.size() != 0) return std::nullopt;
  if (values != f.report_.blocks * FieldLayout::nodes_of_block ||
      f.block_of_.size() != f.layout_.block_count() ||
      f.corners_.size() != f.layout_.corner_count())
    return std::nullopt;
  for (const uint32_t block : f.block_of_)
    if (block != no_index && block >= f.report_.blocks) return std::nullopt;
  return f;
}

}  // namespace tumble
