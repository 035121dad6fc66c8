#include "engine/core/bytes.hpp"

#include <algorithm>

namespace tumble {

void ByteWriter::raw(const void* data, size_t size) {
  if (size == 0) return;
  const auto* p = static_cast<const std::byte*>(data);
  bytes_.insert(bytes_.end(), p, p + size);
}

void ByteWriter::text(std::string_view s) {
  value(uint64_t(s.size()));
  raw(s.data(), s.size());
}

void ByteWriter::begin_section(std::string_view name, uint32_t version) {
  text(name);
  value(version);
  value(uint64_t{0});  // length, filled in by end_section
  section_start_ = bytes_.size();
}

void ByteWriter::end_section() {
  const uint64_t length = bytes_.size() - section_start_;
  std::memcpy(bytes_.data() + section_start_ - sizeof length, &length, sizeof length);
}

void ByteReader::raw(void* data, size_t size) {
  if (!ok_ || size > remaining()) {
    ok_ = false;
    if (size > 0) std::memset(data, 0, size);
    return;
  }
  if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
  at_ += size;
}

void ByteReader::text(std::string& s) {
  const auto n = get<uint64_t>();
  if (n > remaining()) {
    ok_ = false;
    s.clear();
    return;
  }
  s.resize(size_t(n));
  raw(s.data(), size_t(n));
}

uint32_t ByteReader::begin_section(std::string_view name) {
  std::string found;
  text(found);
  const auto version = get<uint32_t>();
  const auto length = get<uint64_t>();
  if (!ok_ || found != name || length > remaining()) {
    ok_ = false;
    return 0;
  }
  section_end_ = at_ + size_t(length);
  return version;
}

void ByteReader::end_section() {
  if (!ok_ || at_ > section_end_) {
    ok_ = false;
    return;
  }
  at_ = section_end_;
}

std::string first_difference(std::span<const std::byte> a, std::span<const std::byte> b) {
  if (std::equal(a.begin(), a.end(), b.begin(), b.end())) return {};
  ByteReader ra(a), rb(b);
  while (ra.remaining() > 0 && rb.remaining() > 0) {
    std::string name_a, name_b;
    ra.text(name_a);
    rb.text(name_b);
    ra.get<uint32_t>();
    rb.get<uint32_t>();
    const auto length_a = ra.get<uint64_t>();
    const auto length_b = rb.get<uint64_t>();
    if (!ra.ok() || !rb.ok() || length_a > ra.remaining() || length_b > rb.remaining()) break;
    Bytes body_a(static_cast<size_t>(length_a)), body_b(static_cast<size_t>(length_b));
    ra.raw(body_a.data(), body_a.size());
    rb.raw(body_b.data(), body_b.size());
    if (name_a != name_b || body_a != body_b) return name_a;
  }
  return "end";
}

}  // namespace tumble
