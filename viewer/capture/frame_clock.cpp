#include "viewer/capture/frame_clock.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <numeric>
#include <string>

#include <fmt/format.h>

namespace tumble {
namespace {

__extension__ using Wide = __int128;

/// Parses the exponent after an 'e' and multiplies by that power of ten; false if it is none, or
/// the number is too large.
bool read_exponent(std::string_view text, int64_t& num, int64_t& den) {
  if (text.starts_with('+') && !text.substr(1).starts_with('-')) text.remove_prefix(1);
  int power = 0;
  const char* end = text.data() + text.size();
  if (const auto [rest, fault] = std::from_chars(text.data(), end, power);
      fault != std::errc() || rest != end)
    return false;
  if (num == 0) return true;
  for (; power != 0; power += power < 0 ? 1 : -1) {
    int64_t& term = power < 0 ? den : num;
    if (term > greatest_term) return false;
    term *= 10;
  }
  return true;
}

/// Parses digits with at most one point, and an exponent; false for anything else, or if the number
/// is too large.
bool read_decimal(std::string_view text, int64_t& num, int64_t& den) {
  num = 0;
  den = 1;
  bool point = false, digits = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((c == 'e' || c == 'E') && digits)
      return read_exponent(text.substr(i + 1), num, den) && num <= greatest_term &&
             den <= 10 * greatest_term;
    if (c == '.' && !point) {
      point = true;
      continue;
    }
    if (c < '0' || c > '9' || num > greatest_term || den > greatest_term) return false;
    digits = true;
    num = 10 * num + (c - '0');
    if (point) den *= 10;
  }
  return digits && num <= greatest_term;
}

uint64_t bounded(Wide n) {
  constexpr auto most = Wide(std::numeric_limits<int64_t>::max());
  return uint64_t(n < most ? n : most);
}

uint64_t rounded(Wide num, Wide den) {
  return bounded((2 * num + den) / (2 * den));
}

}  // namespace

Result<Fraction> parse_fraction(std::string_view text, std::string_view name, bool allow_zero) {
  const size_t slash = text.find('/');
  int64_t n1 = 0, d1 = 1, n2 = 1, d2 = 1;
  const bool fine =
      read_decimal(text.substr(0, slash), n1, d1) &&
      (slash == std::string_view::npos || read_decimal(text.substr(slash + 1), n2, d2));
  const Wide num = Wide(n1) * d2, den = Wide(d1) * n2;
  if (!fine || den == 0 || (num == 0 && !allow_zero) || num > greatest_term || den > greatest_term)
    return Error{ErrorCode::invalid_argument,
                 fmt::format("{}: '{}' is not a {} number of up to 12 digits", name, text,
                             allow_zero ? "non-negative" : "positive"),
                 {},
                 "give it like 30, 2.5, 1e-3 or 30000/1001"};
  const auto n = int64_t(num), d = int64_t(den);
  const int64_t g = std::gcd(n, d);
  return Fraction{n / g, d / g};
}

FrameTime frame_time(uint64_t k, Fraction fps, TickRate rate) {
  // k / fps seconds in ticks: k fps.den rate.num / (fps.num rate.den).
  Wide scale_num = Wide(fps.den) * rate.num, scale_den = Wide(fps.num) * rate.den;
  Wide a = scale_num, b = scale_den;
  while (b != 0) {
    const Wide r = a % b;
    a = b;
    b = r;
  }
  scale_num /= a;
  scale_den /= a;
  const Wide position = Wide(k) * scale_num;
  return {uint64_t(position / scale_den), int64_t(position % scale_den), int64_t(scale_den)};
}

uint64_t frames_until(uint64_t tick, Fraction fps, TickRate rate) {
  // The greatest k with k fps.den rate.num <= tick fps.num rate.den; frames 0 to k can be shown.
  const Wide last = std::min(tick, uint64_t{1} << 40);
  return bounded(last * fps.num * rate.den / (Wide(fps.den) * rate.num) + 1);
}

double frame_seconds(uint64_t k, Fraction fps) {
  return double(k) * double(fps.den) / double(fps.num);
}

uint64_t frame_count(Fraction seconds, Fraction fps) {
  return rounded(Wide(seconds.num) * fps.num, Wide(seconds.den) * fps.den);
}

uint64_t tick_count(Fraction seconds, TickRate rate) {
  return rounded(Wide(seconds.num) * rate.num, Wide(seconds.den) * rate.den);
}

}  // namespace tumble
