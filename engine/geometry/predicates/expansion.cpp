#include "engine/geometry/predicates/expansion.hpp"

namespace tumble {

void Expansion::grow(double x) {
  size_t kept = 0;
  double q = x;
  for (size_t i = 0; i < terms_.size(); ++i) {
    double low;
    two_sum(q, terms_[i], q, low);
    if (low != 0) terms_[kept++] = low;
  }
  terms_.resize(kept);
  if (q != 0) terms_.push_back(q);
}

Expansion Expansion::difference(double a, double b) {
  Expansion out;
  double high, low;
  two_sum(a, -b, high, low);
  if (low != 0) out.terms_.push_back(low);
  if (high != 0) out.terms_.push_back(high);
  return out;
}

Expansion Expansion::product(double a, double b) {
  Expansion out;
  double high, low;
  two_product(a, b, high, low);
  if (low != 0) out.terms_.push_back(low);
  if (high != 0) out.terms_.push_back(high);
  return out;
}

Expansion Expansion::operator+(const Expansion& other) const {
  Expansion out = *this;
  for (double t : other.terms_) out.grow(t);
  return out;
}

Expansion Expansion::operator-() const {
  Expansion out = *this;
  for (double& t : out.terms_) t = -t;
  return out;
}

Expansion Expansion::operator*(double factor) const {
  Expansion out;
  for (double t : terms_) {
    double high, low;
    two_product(t, factor, high, low);
    out.grow(low);
    out.grow(high);
  }
  return out;
}

Expansion Expansion::operator*(const Expansion& other) const {
  Expansion out;
  for (double t : other.terms_) out = out + *this * t;
  return out;
}

double Expansion::estimate() const {
  double sum = 0;
  for (double t : terms_) sum += t;
  return sum;
}

}  // namespace tumble
