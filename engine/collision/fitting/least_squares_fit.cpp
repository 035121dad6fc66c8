#include "engine/collision/fitting/least_squares_fit.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace tumble {
namespace {

constexpr size_t most_unknowns = 9;
constexpr int most_steps = 30;
constexpr double enough = 1e-9;  ///< an improvement by a smaller share is the last
using Step = std::array<double, most_unknowns>;

/// What a guess has to change: three numbers of the centre, of the turn, and its sizes.
size_t unknowns(const PrimitiveKind& kind) {
  return 6 + kind.sizes;
}

PrimitiveGuess stepped(const PrimitiveKind& kind, const PrimitiveGuess& guess, const Step& step,
                       double scale) {
  PrimitiveGuess out = guess;
  out.pose.x += scale * Vec3(step[0], step[1], step[2]);
  const Quat turn(1, 0.5 * step[3], 0.5 * step[4], 0.5 * step[5]);
  out.pose.q = (guess.pose.q * turn.normalized()).normalized();
  for (size_t k = 0; k < kind.sizes; ++k) out.size[k] += scale * step[6 + k];
  return out;
}

double square_sum(const PrimitiveKind& kind, const PrimitiveGuess& guess,
                  std::span<const Vec3> points, std::vector<double>& distances) {
  if (!kind.valid(guess.size)) return std::numeric_limits<double>::infinity();
  const Mat3 to_own = guess.pose.q.conjugate().toRotationMatrix();
  double sum = 0;
  distances.resize(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    distances[i] = kind.distance(guess.size, to_own * (points[i] - guess.pose.x));
    sum += distances[i] * distances[i];
  }
  return sum;
}

}  // namespace

double surface_misfit(const PrimitiveKind& kind, const PrimitiveGuess& guess,
                      std::span<const Vec3> points) {
  std::vector<double> distances;
  return std::sqrt(square_sum(kind, guess, points, distances) / double(points.size()));
}

PrimitiveGuess fit_least_squares(const PrimitiveKind& kind, PrimitiveGuess guess,
                                 std::span<const Vec3> points, double scale) {
  const size_t n = unknowns(kind);
  constexpr double difference = 1e-6;
  constexpr double first_damping = 1e-3, most_damping = 1e8;
  std::vector<double> now, ahead;
  std::array<std::vector<double>, most_unknowns> slopes;
  double misfit = square_sum(kind, guess, points, now), damping = first_damping;
  if (!std::isfinite(misfit)) return guess;
  for (int round = 0; round < most_steps && damping < most_damping; ++round) {
    for (size_t k = 0; k < n; ++k) {
      Step step{};
      step[k] = difference;
      // At a bound of the kind there is no step ahead: what it would change is left alone.
      if (!std::isfinite(square_sum(kind, stepped(kind, guess, step, scale), points, slopes[k]))) {
        slopes[k].assign(points.size(), 0);
        continue;
      }
      for (size_t i = 0; i < points.size(); ++i)
        slopes[k][i] = (slopes[k][i] - now[i]) / difference;
    }
    Eigen::Matrix<double, most_unknowns, most_unknowns> squares;
    Eigen::Matrix<double, most_unknowns, 1> pull;
    squares.setIdentity();
    pull.setZero();
    for (size_t a = 0; a < n; ++a) {
      for (size_t b = 0; b <= a; ++b) {
        double sum = 0;
        for (size_t i = 0; i < points.size(); ++i) sum += slopes[a][i] * slopes[b][i];
        squares(Eigen::Index(a), Eigen::Index(b)) = squares(Eigen::Index(b), Eigen::Index(a)) = sum;
      }
      double sum = 0;
      for (size_t i = 0; i < points.size(); ++i) sum += slopes[a][i] * now[i];
      pull[Eigen::Index(a)] = -sum;
    }
    bool better = false;
    for (; damping < most_damping && !better; damping *= 10) {
      auto damped = squares;
      // What changes nothing, a turn about a round shape's own axis, stays where it is.
      const double floor = 1e-9 * squares.diagonal().maxCoeff();
      for (Eigen::Index k = 0; k < damped.rows(); ++k)
        damped(k, k) += damping * squares(k, k) + floor;
      const Eigen::Matrix<double, most_unknowns, 1> way = damped.ldlt().solve(pull);
      Step step{};
      for (size_t k = 0; k < n; ++k) step[k] = way[Eigen::Index(k)];
      const PrimitiveGuess next = stepped(kind, guess, step, scale);
      const double then = square_sum(kind, next, points, ahead);
      if (!(then < misfit)) continue;
      better = true;
      const bool last = misfit - then < enough * misfit;
      guess = next;
      misfit = then;
      now.swap(ahead);
      if (last) return guess;
      damping *= 1e-2;
    }
    if (!better) break;
  }
  return guess;
}

}  // namespace tumble
