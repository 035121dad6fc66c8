#pragma once
#include "engine/world/world.hpp"
#include "tests/support/accuracy/case_world.hpp"

#include <functional>

namespace tumble::test {

/// A case in a World, by its public interface.
class TumbleCase final : public CaseWorld {
 public:
  struct Watch {
    std::function<void(const std::string&)> complain;  ///< errors and warnings of the engine
    std::function<void(const World&)> after_step = {};
    std::function<void(BodyDef&)> change = {};  ///< what a body is made of, before it is made
  };
  TumbleCase(const CaseScene& scene, WorldSettings settings, Watch watch);
  void step() override;
  CaseState state(size_t body) override;
  void set_force(size_t body, const Vec3& force) override;
  void set_gravity(const Vec3& gravity) override;

 private:
  void check(const Status& done) const;
  Watch watch_;
  std::unique_ptr<World> world_;
  std::vector<BodyId> ids_;
};

/// Makes cases with these settings, at the rate that is asked for.
CaseMaker tumble_maker(const WorldSettings& settings, TumbleCase::Watch watch);

}  // namespace tumble::test
