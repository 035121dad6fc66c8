// Continuous vertex-face and edge-edge queries: ours beside FCL's cubic by Newton's method, false
// answers of both counted against integer arithmetic on the first queries of each family; then our
// awkward families, mean and worst. Times are of the thread, not of the wall.
#include "engine/math/dense.hpp"
#include "tests/bench/contest.hpp"
#include "tests/geometry/continuous_families.hpp"
#include "tests/geometry/continuous_reference.hpp"

#include <ctime>

#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

using namespace tumble;
using namespace tumble::continuous;

namespace {

constexpr int queries = 20000, referred = 2000;

bool by_fcl(const Query& q) {
  using Intersect = fcl::detail::Intersect<double>;
  double time;
  fcl::Vector3d at, from[4], to[4];
  for (size_t k = 0; k < 4; ++k) from[k] = dense(q.p[k].start), to[k] = dense(q.p[k].end);
  return q.edges ? Intersect::intersect_EE(from[0], from[1], from[2], from[3], to[0], to[1], to[2],
                                           to[3], &time, &at)
                 : Intersect::intersect_VF(from[1], from[2], from[3], from[0], to[1], to[2], to[3],
                                           to[0], &time, &at);
}

bool in_integers(const Query& q) {
  return (q.edges ? exact::edge_edge(q.first(), q.second()) : exact::vertex_face(q.p[0], q.face()))
      .has_value();
}

double seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

template <class Answer>
void count(const char* who, const std::vector<Query>& all, const std::vector<bool>& truth,
           const Answer& answer) {
  double best = 1e9;
  for (int round = 0; round < 7; ++round) {
    const double start = seconds();
    for (const Query& q : all) {
      volatile bool keep = answer(q);
      (void)keep;
    }
    best = std::min(best, seconds() - start);
  }
  int negatives = 0, positives = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    const bool hit = answer(all[i]);
    negatives += truth[i] && !hit;
    positives += !truth[i] && hit;
  }
  std::printf("  %-8s %7.4f us mean   of %zu: %d missed, %d false\n", who,
              1e6 * best / double(all.size()), truth.size(), negatives, positives);
}

}  // namespace

int main() {
  for (const bool edges : {false, true}) {
    for (const bool near : {false, true}) {
      Random r(11);
      std::vector<Query> all;
      for (int i = 0; i < queries; ++i) {
        all.push_back(near ? near_query(r, edges) : random_query(r, edges));
      }
      std::vector<bool> truth;
      for (int i = 0; i < referred; ++i) truth.push_back(in_integers(all[size_t(i)]));
      std::printf("%s, %s\n", edges ? "edge-edge" : "vertex-face", near ? "near" : "random");
      count("ours", all, truth, [](const Query& q) { return q.answer().has_value(); });
      count("FCL", all, truth, by_fcl);
    }
  }
  std::printf("awkward families, ours: us\n");
  for (int family = 0; family < hostile_families; ++family) {
    Random r(12);
    std::vector<Query> all;
    for (int i = 0; i < 4000; ++i) {
      all.push_back(hostile_query(r, family, i % 2 != 0));
      rescale(r, all.back());
    }
    std::vector<double> least(all.size(), 1e9);
    double mean = 1e9;
    for (int round = 0; round < 5; ++round) {
      const double begin = seconds();
      for (const Query& q : all) {
        volatile bool keep = q.answer().has_value();
        (void)keep;
      }
      mean = std::min(mean, (seconds() - begin) / double(all.size()));
      for (size_t i = 0; i < all.size(); ++i) {
        const double start = seconds();
        volatile bool keep = all[i].answer().has_value();
        (void)keep;
        least[i] = std::min(least[i], seconds() - start);
      }
    }
    std::printf("  %-28s %8.3f mean %8.2f worst\n", hostile_name(family), 1e6 * mean,
                1e6 * *std::max_element(least.begin(), least.end()));
  }
}
