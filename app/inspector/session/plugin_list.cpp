#include "inspector/session/plugin_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "inspector/session/track_statistics.h"
#include "request/plugins.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

struct Checked {
  std::size_t frames = 0;
  std::size_t wrong = 0;
};

Checked checkedIn(const TrackReport& track) {
  Checked checked;
  for (const FrameRecord& record : track.frames) {
    if (!record.run || !record.checked) continue;
    ++checked.frames;
    if (record.mismatch) ++checked.wrong;
  }
  return checked;
}

std::string wrongText(const Checked& checked) {
  return fmt::format("{} of {}", checked.wrong, counted(checked.frames, "frame"));
}

}  // namespace

std::string rebuiltText(const TrackReport& before, const TrackReport& now) {
  const std::string& id = now.spec.test_case.algorithm.id;
  if (hasFailed(now)) return fmt::format("{}: rebuilt: {}", id, now.reason);
  const Checked former = checkedIn(before);
  const Checked fresh = checkedIn(now);
  const bool was_right = former.wrong == 0 && !hasFailed(before);
  if (was_right && fresh.wrong == 0) {
    const TimeRatios ratios = ratiosOf(before, now);
    if (!ratios.highest) return fmt::format("{}: rebuilt", id);
    return fmt::format("{}: {:.3g} times as fast on {}", id, ratios.median,
                       counted(ratios.first_slower + ratios.second_slower, "frame"));
  }
  std::string then = fmt::format("{} before", wrongText(former));
  if (hasFailed(before)) then = fmt::format("ended in frame {} before", failedFrame(before));
  return fmt::format("{}: {}{} wrong, {}", id, fresh.wrong == 0 ? "fixed: " : "", wrongText(fresh),
                     then);
}

PluginList::PluginList(TrackList& tracks, Playback& playback, Notices& notices)
    : tracks_(tracks), playback_(playback), notices_(notices) {
  for (const Algorithm& algorithm : tracks.algorithms()) {
    if (!algorithm.plugin.empty()) watch(algorithm.plugin);
  }
}

PluginList::Stamp PluginList::stampOf(const std::string& plugin) {
  Stamp stamp;
  for (const fs::path& file : pluginFiles(plugin)) {
    std::error_code failed;
    const std::uintmax_t bytes = fs::file_size(file, failed);
    const fs::file_time_type written = fs::last_write_time(file, failed);
    if (failed) return {};
    stamp.emplace_back(written, bytes);
  }
  return stamp;
}

void PluginList::watch(const std::string& plugin) {
  const Stamp now = stampOf(plugin);
  const auto found = std::ranges::find(watched_, plugin, &Watched::plugin);
  if (found == watched_.end()) {
    watched_.push_back({plugin, now, now});
  } else {
    found->loaded = now;
  }
}

std::vector<Algorithm> PluginList::algorithmsIn(const std::string& plugin) const {
  std::vector<Algorithm> others = tracks_.algorithms();
  std::erase_if(others, [&](const Algorithm& other) { return other.plugin == plugin; });
  std::vector<Algorithm> algorithms = algorithmsOf(plugin, others, PluginLoading::copy);
  if (!algorithms.empty()) return algorithms;
  throw InputError(fmt::format("{}: has no algorithm; its engines need --plugin", plugin));
}

void PluginList::load(const fs::path& file) {
  notices_.catchErrors([&] {
    if (isSandboxed()) {
      throw InputError(
          fmt::format("{}: scripts may not load algorithms: use --plugin", file.string()));
    }
    add(file);
    notices_.raisePanel("Algorithms");
  });
}

void PluginList::loadShipped(const std::string& name) { add(shippedPlugin(name)); }

void PluginList::add(const fs::path& file) {
  const std::string plugin = pluginOf(file);
  watch(plugin);
  const std::vector<Algorithm> loaded = algorithmsIn(plugin);
  tracks_.replaceAlgorithms(plugin, loaded);
  if (loaded.size() == 1) tracks_.add(loaded.front().id);
  notices_.setStatus(
      fmt::format("{}: {}", file.filename().string(), counted(loaded.size(), "algorithm")));
}

void PluginList::reloadRebuilt(const RunProgress& progress) {
  for (Watched& watched : watched_) {
    const Stamp now = stampOf(watched.plugin);
    // A file that is being written changes from picture to picture.
    const bool is_complete = std::exchange(watched.last_seen, now) == now && !now.empty();
    if (!is_complete || std::exchange(watched.loaded, now) == now) continue;
    try {
      reload(watched.plugin, progress);
    } catch (const std::exception& error) {
      notices_.setStatus(error.what(), Severity::error);
    }
  }
}

void PluginList::reload(const std::string& plugin, const RunProgress& progress) {
  const std::vector<Algorithm> loaded = algorithmsIn(plugin);
  std::erase_if(reruns_, [&](const Rerun& rerun) {
    return rerun.before.spec.test_case.algorithm.plugin == plugin;
  });
  std::optional<std::int64_t> last;
  for (const TrackEdit& track : tracks_.list) {
    const TrackReport* const before = findTrack(progress.tracks, track.number);
    if (track.test_case.algorithm.plugin != plugin || before == nullptr) continue;
    const bool was_right = checkedIn(*before).wrong == 0 && !hasFailed(*before);
    last = std::max<std::int64_t>(last.value_or(playback_.frame()),
                                  was_right ? before->frames.size() : playback_.lastFrame());
    reruns_.push_back({progress.source, *before});
  }
  tracks_.replaceAlgorithms(plugin, loaded);
  if (last) playback_.goTo(*last);
  notices_.setStatus(fmt::format("{}: rebuilt", plugin));
}

void PluginList::compare(const RunProgress& progress) {
  if (!playback_.hasReached(progress)) return;
  std::string text;
  std::erase_if(reruns_, [&](const Rerun& rerun) {
    const int number = rerun.before.spec.number;
    const TrackEdit* const track = tracks_.find(number);
    if (rerun.source != progress.source || track == nullptr) return true;
    const TrackReport* const now = findTrack(progress.tracks, number);
    if (now == nullptr || now->spec != *track) return false;
    if (!now->finished && now->record(playback_.frame()) == nullptr) return false;
    text += (text.empty() ? "" : "; ") + rebuiltText(rerun.before, *now);
    return true;
  });
  if (!text.empty()) notices_.setStatus(text);
}

}  // namespace broadmark
