#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tumble {

/// A whole number of at most `Bits` bits and a sign. Sums and products have types that hold them,
/// so that nothing overflows and nothing is allocated: for determinants whose degree is known.
template <int Bits>
class Integer {
 public:
  static constexpr int limbs = (Bits + 63) / 64;

  constexpr Integer() = default;

  /// x / 2^exponent without its fraction. |x| must be below 2^(exponent + Bits).
  static Integer from(double x, int exponent) {
    Integer out;
    if (x == 0) return out;
    int e = 0;
    const auto digits = uint64_t(std::ldexp(std::frexp(std::fabs(x), &e), 53));
    const int shift = e - 53 - exponent;
    out.negative_ = x < 0;
    if (shift <= 0) {
      out.limb_[0] = shift > -64 ? digits >> -shift : 0;
    } else {
      out.limb_[size_t(shift / 64)] = digits << (shift % 64);
      if (shift % 64 > 11 && shift / 64 + 1 < limbs)
        out.limb_[size_t(shift / 64) + 1] = digits >> (64 - shift % 64);
    }
    return out;
  }

  /// The same number, which must fit, in fewer bits or more.
  template <int Other>
  static Integer fitted(const Integer<Other>& x) {
    Integer out;
    for (size_t i = 0; i < out.limb_.size(); ++i) out.limb_[i] = x.limb(i);
    out.negative_ = x.negative_;
    return out;
  }

  int sign() const {
    for (const uint64_t l : limb_)
      if (l) return negative_ ? -1 : 1;
    return 0;
  }
  /// Within 2^-51 of the number.
  double estimate() const {
    for (int i = limbs - 1; i >= 0; --i) {
      if (!limb_[size_t(i)]) continue;
      double out = double(limb_[size_t(i)]);
      if (i > 0) out += std::ldexp(double(limb_[size_t(i) - 1]), -64);
      return std::ldexp(negative_ ? -out : out, 64 * i);
    }
    return 0;
  }

  Integer operator-() const {
    Integer out = *this;
    out.negative_ = !negative_;
    return out;
  }

  template <int Other>
  auto operator+(const Integer<Other>& b) const {
    Integer<std::max(Bits, Other) + 1> out;
    if (negative_ == b.negative_) {
      uint64_t carry = 0;
      for (size_t i = 0; i < out.limb_.size(); ++i) {
        const Wide sum = Wide(limb(i)) + b.limb(i) + carry;
        out.limb_[i] = uint64_t(sum);
        carry = uint64_t(sum >> 64);
      }
      out.negative_ = negative_;
      return out;
    }
    const bool swap = smaller(b);
    uint64_t borrow = 0;
    for (size_t i = 0; i < out.limb_.size(); ++i) {
      const uint64_t x = swap ? b.limb(i) : limb(i), y = swap ? limb(i) : b.limb(i);
      const Wide difference = Wide(x) - y - borrow;
      out.limb_[i] = uint64_t(difference);
      borrow = uint64_t(difference >> 64) & 1;
    }
    out.negative_ = swap ? b.negative_ : negative_;
    return out;
  }
  template <int Other>
  auto operator-(const Integer<Other>& b) const {
    return *this + -b;
  }
  template <int Other>
  auto operator*(const Integer<Other>& b) const {
    Integer<Bits + Other> out;
    for (size_t i = 0; i < limb_.size(); ++i) {
      if (!limb_[i]) continue;
      uint64_t carry = 0;
      for (size_t j = 0; i + j < out.limb_.size(); ++j) {
        if (j >= b.limb_.size() && !carry) break;
        const Wide sum = Wide(limb_[i]) * b.limb(j) + out.limb_[i + j] + carry;
        out.limb_[i + j] = uint64_t(sum);
        carry = uint64_t(sum >> 64);
      }
    }
    out.negative_ = negative_ != b.negative_;
    return out;
  }

 private:
  template <int>
  friend class Integer;
  __extension__ using Wide = unsigned __int128;

  uint64_t limb(size_t i) const { return i < limb_.size() ? limb_[i] : 0; }
  /// In magnitude.
  template <int Other>
  bool smaller(const Integer<Other>& b) const {
    for (size_t i = std::max(limb_.size(), b.limb_.size()); i-- > 0;)
      if (limb(i) != b.limb(i)) return limb(i) < b.limb(i);
    return false;
  }

  std::array<uint64_t, size_t(limbs)> limb_{};  ///< the smallest first
  bool negative_ = false;
};

}  // namespace tumble
