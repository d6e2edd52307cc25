// The form of the panel Batch that runs algorithms on recordings.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "inspector/panels/batch_form.h"
#include "inspector/session/text_lists.h"
#include "request/cases.h"
#include "request/run_request.h"

namespace broadmark {

class BenchmarkForm : BatchForm {
 public:
  explicit BenchmarkForm(const PanelContext& context) : BatchForm(context) {}

  void draw() {
    BackgroundBenchmark& benchmark = session.jobs.get<BackgroundBenchmark>();
    const BackgroundBenchmark::Report report = benchmark.report();
    const bool running = benchmark.running();
    if (drawStart(benchmark, "Run in the background; pause playback for accurate times",
                  "Stop; finished cases are kept")) {
      askOrStart();
    }
    ImGui::BeginDisabled(running);
    drawOptions();
    ImGui::EndDisabled();
    if (report.state == TaskState::idle) {
      drawPreview();
    } else {
      drawItems(report);
    }
  }

 private:
  using Path = std::filesystem::path;

  /// Returns the sorted box recordings below a folder; none if it does not exist.
  static std::vector<Path> recordingsBelow(const Path& folder) {
    const std::vector<std::string> extensions = boxRecordingExtensions();
    std::vector<Path> recordings;
    std::error_code failed;
    for (std::filesystem::recursive_directory_iterator entry(folder, failed), end;
         !failed && entry != end; entry.increment(failed)) {
      const bool matches =
          std::ranges::find(extensions, entry->path().extension().string()) != extensions.end();
      if (matches && entry->is_regular_file(failed)) recordings.push_back(entry->path());
    }
    std::ranges::sort(recordings);
    return recordings;
  }

  void start() {
    session.notices.catchErrors([&] {
      startBenchmark(session.jobs.get<BackgroundBenchmark>(), request(),
                     session.tracks.algorithms(), session.jobs.make_executor, session.jobs.host);
    });
  }

  /// Asks for another file rather than replacing one.
  void askOrStart() {
    if (!std::filesystem::exists(results_)) return start();
    files.ask({.title = fmt::format("{} exists: write the results to", results_),
               .purpose = FileDialog::Purpose::save,
               .extensions = {".json"},
               .suggestion = unusedName(results_),
               .chosen = [this](const Path& path) {
                 results_ = path.string();
                 start();
               }});
  }

  /// A path like this one without a file: "results-2.json".
  static Path unusedName(const Path& path) {
    std::string stem = path.stem().string();
    if (const std::size_t digits = stem.find_last_not_of("0123456789");
        digits != stem.npos && stem[digits] == '-' && digits + 1 < stem.size()) {
      stem.erase(digits);
    }
    Path unused = path;
    for (int number = 2; std::filesystem::exists(unused); ++number) {
      unused.replace_filename(fmt::format("{}-{}{}", stem, number, path.extension().string()));
    }
    return unused;
  }

  void drawOptions() {
    ui.heading("Recordings");
    drawFolder("folder", "Folder of recordings", directory_, stale_);
    if (stale_ || ImGui::IsWindowAppearing()) findRecordings();
    drawRecordings();
    ui.heading("Run settings");
    ui.text("algorithms", algorithms_, "sap*, kd, all");
    ui.tooltip("Ids, families, patterns or all, as for --algorithm");
    if (wideButton("From Algorithms", "Use the algorithms of the panel Algorithms")) {
      algorithms_.clear();
      for (const TrackEdit& track : session.tracks.list) {
        algorithms_ += (algorithms_.empty() ? "" : ", ") + track.test_case.algorithm.id;
      }
    }
    ui.text("threads", threads_, "1, 2");
    ui.tooltip("Thread counts of parallel algorithms, one case each");
    ui.integer("repetitions", repetitions_, 1, 1000,
               "Number of runs of each case, interleaved with the other cases");
    ui.combo("check", check_, kCheckModes.names(),
             "full: exact pairs in every frame; hash: counts and hashes; off");
    ui.text("results", results_, "results.json");
  }

  void findRecordings() {
    stale_ = false;
    const auto before = std::exchange(recordings_, {});
    for (const Path& path : recordingsBelow(directory_)) {
      const auto previous = std::ranges::find(before, path, &std::pair<Path, bool>::first);
      recordings_.emplace_back(path, previous == before.end() || previous->second);
    }
  }

  void drawRecordings() {
    if (recordings_.empty()) {
      ui.faintParagraph("No recordings in this folder: bake some, or choose another folder.");
      return;
    }
    const auto scope = ui.scope("recordings");
    for (auto& [path, marked] : recordings_) {
      ui.checkbox(path.filename().string().c_str(), marked, path.string().c_str());
    }
  }

  /// Throws InputError for invalid inputs.
  [[nodiscard]] RunRequest request() const {
    RunRequest request;
    for (const auto& [path, marked] : recordings_) {
      if (marked) request.sources.push_back(path.string());
    }
    if (request.sources.empty()) throw InputError("no recording is chosen");
    request.cases.algorithms = parseWords(algorithms_);
    if (request.cases.algorithms.empty()) throw InputError("no algorithm is chosen");
    for (const std::uint32_t threads : parseCounts(threads_, "number of threads", 256)) {
      request.cases.threads.push_back(static_cast<int>(threads));
    }
    request.repetitions.max_count = static_cast<int>(repetitions_);
    request.policy.check = kCheckModes.entries.at(check_).value;
    if (results_.empty()) throw InputError("a file for the results is needed");
    request.outputs = {{"json", results_}};
    return request;
  }

  /// Draws the number of cases and recordings, or the error in the inputs.
  void drawPreview() const {
    ui.heading("To run");
    try {
      const RunRequest request = this->request();
      const auto cases = selectCases(request.cases, {}, session.tracks.algorithms());
      ui.paragraph(fmt::format("{} on {}", counted(cases.size(), "case"),
                               counted(request.sources.size(), "recording")));
    } catch (const InputError& error) {
      ui.paragraph(error.what(), ui.theme.warning);
    }
  }

  void drawItems(const BenchmarkReport& report) {
    ui.heading(fmt::format("{}: {}", kTaskStates.nameOf(report.state), report.text()).c_str());
    const bool any_saved = std::ranges::any_of(report.items, &BenchmarkReport::Item::saved);
    if (report.state != TaskState::running && any_saved &&
        wideButton("Open results", "List the results in the panel Cases")) {
      session.open(report.file);
    }
    const auto scope = ui.scope("cases");
    clipped(report.items.size(), [&](std::size_t row) {
      const BenchmarkReport::Item& item = report.items[row];
      const bool ok = item.status == Status::ok;
      ImGui::BeginDisabled(!item.saved && report.state == TaskState::running);
      const std::string right =
          ok ? durationText(item.median_seconds) : std::string(statusName(item.status));
      if (ui.selectableLine(item.name.c_str(), false, right, ok ? ui.theme.good : ui.theme.bad,
                            item.reason.empty() ? "Open the case" : item.reason.c_str())) {
        session.openCase(report.file, item.id);
      }
      if (row == 0) ui.note("first");
      ImGui::EndDisabled();
    });
  }

  std::string directory_ = "recordings";
  std::vector<std::pair<Path, bool>> recordings_;  ///< with their checkboxes
  bool stale_ = true;                              ///< recordings_ is outdated
  std::string algorithms_ = "sap, kd, grid2d-sap, columns";
  std::string threads_ = "1";
  std::int64_t repetitions_ = 3;
  std::size_t check_ = 0;
  std::string results_ = "results.json";
};

}  // namespace broadmark
