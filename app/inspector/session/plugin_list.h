// Plug-ins of the session: loaded from the menu, and loaded again once they have been rebuilt.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inspector/run/run_thread.h"
#include "inspector/session/notices.h"
#include "inspector/session/playback.h"
#include "inspector/session/track_list.h"

namespace broadmark {

/// Whether a file is named like a shared library.
inline bool isLibraryFile(const std::filesystem::path& file) { return file.extension() == ".so"; }

class PluginList {
 public:
  /// Watches the plug-ins of the available algorithms. The arguments must outlive this object.
  PluginList(TrackList& tracks, Playback& playback, Notices& notices);

  /// Loads the algorithms of a plug-in, a program (external.md), or a log of pairs; adds a single
  /// one as a track. Reports errors.
  void load(const std::filesystem::path& file);
  /// The same for a plug-in that ships with the program. Throws InputError.
  void loadShipped(const std::string& name);
  /// Call once per picture: loads plug-ins again that were rebuilt. Their tracks run all frames
  /// again.
  void reloadRebuilt(const RunProgress& progress);
  /// Call with the progress of the playback's source: once the tracks of a rebuilt plug-in have
  /// run, reports how they differ from those of the former build.
  void compare(const RunProgress& progress);

 private:
  /// What changes when a file is written; empty unless all of a plug-in's files exist.
  using Stamp = std::vector<std::pair<std::filesystem::file_time_type, std::uintmax_t>>;
  struct Watched {
    std::string plugin;
    Stamp loaded;
    Stamp last_seen;
  };
  /// A track that runs again.
  struct Rerun {
    std::shared_ptr<const FrameProviderRequest> source;
    TrackReport before;
  };

  void add(const std::filesystem::path& file);
  static Stamp stampOf(const std::string& plugin);
  void watch(const std::string& plugin);
  /// Throws InputError, also if there are none.
  [[nodiscard]] std::vector<Algorithm> algorithmsIn(const std::string& plugin) const;
  void reload(const std::string& plugin, const RunProgress& progress);

  TrackList& tracks_;
  Playback& playback_;
  Notices& notices_;
  std::vector<Watched> watched_;
  std::vector<Rerun> reruns_;
};

/// The frames and times of a rebuilt algorithm beside those of its former build:
/// "kd: fixed: 0 of 60 frames wrong, 1 of 1 frame before", "kd: 1.31 times as fast on 60 frames".
std::string rebuiltText(const TrackReport& before, const TrackReport& now);

}  // namespace broadmark
