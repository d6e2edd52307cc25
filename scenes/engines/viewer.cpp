// Viewer: the frames of a recording as they are.

#include "broadmark/error.h"
#include "broadmark/recordings/posrot.h"
#include "engines/replay.h"
#include "entries.h"

namespace broadmark::scenes::viewer {
namespace {

class Viewer final : public Replay {
 public:
  explicit Viewer(std::unique_ptr<Recording> recording) : recording_(std::move(recording)) {}

  [[nodiscard]] const SceneInfo& scene() const override { return recording_->scene(); }
  Frame rewind() override { return recording_->rewind(); }
  std::optional<Frame> next() override { return recording_->next(); }
  std::string inputHash() override { return recording_->hash(); }
  std::span<const Aabb> unturnedBoxes() override { return posed().unturnedBoxes(); }
  std::span<const Pose> poses() override { return posed().poses(); }

 private:
  [[nodiscard]] PoseSource& posed() const {
    if (auto* source = dynamic_cast<PoseSource*>(recording_.get())) return *source;
    throw InputError(recording_->name() + ": holds boxes only, not the poses that .posrot needs");
  }

  std::unique_ptr<Recording> recording_;
};

}  // namespace

ReplayEntry entry() {
  return {.listing = {.id = "viewer",
                      .summary = "replays a recording (.posrot, .aabbs, .broadmark)",
                      .dynamics = Dynamics::replayed},
          .bodies_per_recorded = 1,
          .extensions = {kPosrotExtension, kAabbsExtension, kBroadmarkExtension},
          .create = makeAs<Replay, Viewer>};
}

}  // namespace broadmark::scenes::viewer
