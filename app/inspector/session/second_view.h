// What is shown beside the first view.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "inspector/run/run_thread.h"
#include "inspector/session/footage_requests.h"
#include "inspector/session/lanes.h"
#include "inspector/session/notices.h"

namespace broadmark {

class SecondView {
 public:
  /// The parts it acts on outlive it.
  SecondView(Notices& notices, Playback& playback, Lanes& lanes)
      : notices_(notices), playback_(playback), lanes_(lanes) {}

  /// Shows another algorithm's answer if there is one, or closes the view.
  void show(bool on) {
    wish.reset();
    if (!on) return;
    wish.emplace();
    const auto other = std::ranges::find_if(
        lanes_.list, [this](const LaneEdit& lane) { return lane.number != lanes_.shown(); });
    if (other != lanes_.list.end()) wish->lane = other->number;
    // Without another algorithm's answer it is the same one's, and stays where it is.
    if (other == lanes_.list.end() && lanes_.shown() == 0) wish->frame = playback_.frame();
  }

  /// Shows a recording. A bad one becomes an error.
  void showRecording(const std::filesystem::path& path) {
    notices_.attempt([&] {
      FootageRequest footage = recordingFootage(path, {}, playback_.swept);
      if (!wish) show(true);
      wish->footage = std::make_shared<const FootageRequest>(std::move(footage));
      wish->frame.reset();
      wish->lane = lanes_.shown();
    });
  }

  std::optional<SecondWish> wish;  ///< nothing: there is no second view
  bool linked = true;              ///< one camera moves both views

 private:
  Notices& notices_;
  Playback& playback_;
  Lanes& lanes_;
};

}  // namespace broadmark
