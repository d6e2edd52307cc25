#include "inspector/session/second_view.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "inspector/session/footage_requests.h"

namespace broadmark {

void SecondView::show(bool on) {
  wish.reset();
  if (!on) return;
  wish.emplace();
  const auto other = std::ranges::find_if(
      lanes_.list, [this](const LaneEdit& lane) { return lane.number != lanes_.shown(); });
  if (other != lanes_.list.end()) wish->lane = other->number;
  // Without another algorithm's answer it is the same one's, and stays where it is.
  if (other == lanes_.list.end() && lanes_.shown() == 0) wish->frame = playback_.frame();
}

void SecondView::showRecording(const std::filesystem::path& path) {
  notices_.attempt([&] {
    FootageRequest footage = recordingFootage(path, {}, playback_.swept);
    if (!wish) show(true);
    wish->footage = std::make_shared<const FootageRequest>(std::move(footage));
    wish->frame.reset();
    wish->lane = lanes_.shown();
  });
}

}  // namespace broadmark
