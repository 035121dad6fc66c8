#pragma once
#include "engine/dynamics/joints/coordinate_drive.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace tumble {

/// Memory for the drives of joints whose motors follow courses, which are others in every tick.
/// Joints share their drives with copies of the tick before, in which they must not change: new
/// ones are written where nobody holds the old ones any longer. To be used by one thread, while no
/// other one copies or drops joints.
class KeptDrives {
 public:
  std::shared_ptr<const JointDrives> hold(const JointDrives& drives) {
    // The place that was written longest ago is free first.
    for (size_t looked = 0; looked < kept_.size(); ++looked) {
      const std::shared_ptr<JointDrives>& place = kept_[next_];
      next_ = (next_ + 1) % kept_.size();
      if (place.use_count() > 1) continue;
      *place = drives;
      return place;
    }
    return kept_.emplace_back(std::make_shared<JointDrives>(drives));
  }
  size_t bytes() const {
    return kept_.capacity() * sizeof(kept_[0]) + kept_.size() * sizeof(JointDrives);
  }

 private:
  std::vector<std::shared_ptr<JointDrives>> kept_;
  size_t next_ = 0;
};

}  // namespace tumble
