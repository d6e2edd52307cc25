// What is shown beside the first view.
#pragma once

#include <filesystem>
#include <optional>

#include "inspector/run/run_thread.h"
#include "inspector/session/lanes.h"
#include "inspector/session/notices.h"
#include "inspector/session/playback.h"

namespace broadmark {

class SecondView {
 public:
  /// The parts it acts on outlive it.
  SecondView(Notices& notices, Playback& playback, Lanes& lanes)
      : notices_(notices), playback_(playback), lanes_(lanes) {}

  /// Shows another algorithm's answer if there is one, or closes the view.
  void show(bool on);
  /// Shows a recording. A bad one becomes an error.
  void showRecording(const std::filesystem::path& path);

  std::optional<SecondWish> wish;  ///< nothing: there is no second view
  bool linked = true;              ///< one camera moves both views

 private:
  Notices& notices_;
  Playback& playback_;
  Lanes& lanes_;
};

}  // namespace broadmark
