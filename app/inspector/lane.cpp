#include "inspector/lane.h"

#include <fmt/format.h>

#include "broadmark/error.h"

namespace broadmark {

void Lane::fail(Status status, std::string reason) {
  report_.status = status;
  report_.reason = std::move(reason);
  instance_.reset();
}

void Lane::restart(const SceneInfo& scene, const Frame& first) {
  instance_.reset();  // two may not live side by side
  report_.frame = 0;
  seconds_ = 0;
  try {
    instance_ = std::make_unique<CaseInstance>(spec().run, scene);
    report_.margin = instance_->capabilities().margin;
    report_.initialize_ns = instance_->initialize(scene, first);
  } catch (const UnsupportedError& unsupported) {
    fail(Status::unsupported, unsupported.what());
  } catch (const std::exception& error) {
    fail(Status::error, error.what());
  }
}

FrameRecord& Lane::recordOf(std::uint32_t index) {
  if (report_.frames.size() < index) report_.frames.resize(index);
  return report_.frames[index - 1];
}

void Lane::advance(const Frame& frame, DrawGate& gate) {
  FrameRecord record;
  gate.beginTiming();
  try {
    record.times = runFrame(instance_->algorithm(), frame);
  } catch (const std::exception& error) {
    fail(Status::error, fmt::format("frame {}: {}", frame.index, error.what()));
  }
  record.disturbed = gate.endTiming();
  if (instance_ == nullptr) return;
  record.run = true;
  record.pairs = pairCount(instance_->algorithm().overlaps());
  recordOf(frame.index) = record;
  report_.frame = frame.index;
  report_.counters.clear();
  instance_->algorithm().visitCounters(
      [&](std::string_view name, std::uint64_t count) { report_.counters.emplace(name, count); });
  seconds_ += static_cast<double>(record.times[Phase::total]) * 1e-9;
  if (seconds_ > kFrameLimitSeconds * frame.index) {
    fail(Status::timeout, fmt::format("{:.3g} s/frame after frame {}: over the limit of {} s",
                                      seconds_ / frame.index, frame.index, kFrameLimitSeconds));
  }
}

FrameDifference Lane::check(const Frame& frame, Oracle& oracle) {
  FrameDifference difference = instance_->check(frame, oracle, CheckMode::hash);
  FrameRecord& record = recordOf(frame.index);
  record.checked = true;
  record.missed = difference.missed_count;
  record.extra = difference.extra_count;
  record.mismatch = difference.isMismatch();
  if (record.mismatch && report_.status == Status::ok) {
    report_.status = Status::mismatch;
    report_.reason =
        fmt::format("frame {}: {} missed, {} false, {} invalid", frame.index,
                    difference.missed_count, difference.forbidden_count, difference.invalid_count);
  }
  return difference;
}

}  // namespace broadmark
