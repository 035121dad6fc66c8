#include "engine/geometry/predicates/expansion.hpp"

namespace tumble {

void Expansion::grow(double x) {
  size_t kept = 0;
  if (x == 0) return;
  double q = x;
  for (size_t i = 0; i < terms_.size(); ++i) {
    double low;
    two_sum(q, terms_[i], q, low);
    if (low != 0) terms_[kept++] = low;
  }
  terms_.resize(kept);
  if (q != 0) terms_.push_back(q);
}

/// Fewest terms for the same sum (Shewchuk 1997, figure 15): products stay short.
void Expansion::compress() {
  const size_t n = terms_.size();
  if (n < 3) return;
  size_t bottom = n - 1;
  double q = terms_[bottom];
  for (size_t i = n - 1; i-- > 0;) {
    double high, low;
    two_sum(q, terms_[i], high, low);
    q = high;
    if (low != 0) {
      terms_[bottom--] = high;
      q = low;
    }
  }
  terms_[bottom] = q;
  size_t top = 0;
  for (size_t i = bottom + 1; i < n; ++i) {
    double high, low;
    two_sum(terms_[i], q, high, low);
    if (low != 0) terms_[top++] = low;
    q = high;
  }
  terms_[top++] = q;
  terms_.resize(top);
}

Expansion Expansion::sum(double a, double b) {
  Expansion out;
  double high, low;
  two_sum(a, b, high, low);
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
  out.compress();
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
  for (double t : other.terms_) {
    for (double u : terms_) {
      double high, low;
      two_product(t, u, high, low);
      out.grow(low);
      out.grow(high);
    }
  }
  out.compress();
  return out;
}

double Expansion::estimate() const {
  double sum = 0;
  for (double t : terms_) sum += t;
  return sum;
}

}  // namespace tumble
