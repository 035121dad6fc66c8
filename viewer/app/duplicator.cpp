#include "viewer/app/duplicator.hpp"

#include "engine/world/world.hpp"
#include "viewer/interact/picking.hpp"

#include <string>

#include <fmt/format.h>

namespace tumble {
namespace {

/// "crate" -> "crate 2", "crate 2" -> "crate 3": the first such name that nobody has.
std::string free_name(const World& world, const std::string& name) {
  if (name.empty()) return {};
  const size_t end = name.find_last_not_of("0123456789");
  const bool numbered = end != std::string::npos && end + 1 < name.size() && name[end] == ' ';
  const std::string stem = numbered ? name.substr(0, end) : name;
  for (int n = 2;; ++n) {
    std::string next = fmt::format("{} {}", stem, n);
    if (world.find_body(next).is_null()) return next;
  }
}

}  // namespace

void Duplicator::copy(Session& session, BodyId body, const Vec3& aside, bool repeat) {
  const BodyId before = repeat && body == copy_ ? original_ : BodyId{};
  original_ = body;
  made_ = session.call([body, before, aside](World& world) -> BodyId {
    auto def = world.body_def(body);
    if (!def) return {};
    const auto first = before.is_null() ? std::nullopt : world.body_def(before);
    if (first)
      def->pose = def->pose * (first->pose.inverse() * def->pose);
    else
      def->pose.x += aside;
    def->name = free_name(world, def->name);
    def->starts_asleep = false;
    const auto made = world.create_body(*std::move(def));
    return made ? *made : BodyId{};
  });
}

std::optional<BodyId> Duplicator::take(const Frame& shown) {
  if (made_.valid() && made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    copy_ = made_.get();
    awaited_ = !copy_.is_null();
  }
  if (!awaited_ || !find_slot(shown, copy_)) return std::nullopt;
  awaited_ = false;
  return copy_;
}

}  // namespace tumble
