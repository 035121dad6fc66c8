#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tumble {

using Bytes = std::vector<std::byte>;

/// Appends values to a byte string; the counterpart of ByteReader. Scalars are stored in the
/// machine's (little-endian) order, sizes as 64-bit counts, sections as name, version and length.
class ByteWriter {
 public:
  /// Appends a trivially copyable value. Types with padding bytes must be written by member.
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&v, sizeof v);
  }
  void raw(const void* data, size_t size);
  void text(std::string_view s);
  /// Appends the count and the elements (trivially copyable, without padding).
  template <class T, class A>
  void vector(const std::vector<T, A>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(uint64_t(v.size()));
    raw(v.data(), v.size() * sizeof(T));
  }

  /// Opens a named, versioned section; close it with end_section before opening the next.
  void begin_section(std::string_view name, uint32_t version);
  void end_section();

  const Bytes& bytes() const { return bytes_; }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
  size_t section_start_ = 0;
};

/// Reads what a ByteWriter wrote. Reading past the end, or a count larger than the rest, calls
/// fail(); from then on all values are zero. It never reads outside the span.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&v, sizeof v);
  }
  template <class T>
  T get() {
    T v{};
    value(v);
    return v;
  }
  void raw(void* data, size_t size);
  void text(std::string& s);
  template <class T, class A>
  void vector(std::vector<T, A>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto n = get<uint64_t>();
    if (n > remaining() / sizeof(T)) {
      fail();
      v.clear();
      return;
    }
    v.resize(size_t(n));
    raw(v.data(), size_t(n) * sizeof(T));
  }

  /// Enters the next section if it has this name; gives its version, or 0 (and fails) if not.
  uint32_t begin_section(std::string_view name);
  /// Leaves the section, and skips what a newer version appended to it.
  void end_section();

  bool ok() const { return ok_; }
  void fail() { ok_ = false; }
  size_t remaining() const { return bytes_.size() - at_; }

 private:
  std::span<const std::byte> bytes_;
  size_t at_ = 0;
  size_t section_end_ = 0;
  bool ok_ = true;
};

/// The name of the first section in which two byte strings differ; empty when they are equal.
std::string first_difference(std::span<const std::byte> a, std::span<const std::byte> b);

}  // namespace tumble
