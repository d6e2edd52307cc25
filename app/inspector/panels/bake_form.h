// The form of the panel Batch that bakes recordings: scenes × object types × object counts.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bake/bake_plan.h"
#include "broadmark/cores.h"
#include "broadmark/error.h"
#include "inspector/panels/batch_form.h"
#include "inspector/session/text_lists.h"

namespace broadmark {

class BakeForm : BatchForm {
 public:
  explicit BakeForm(const PanelContext& context) : BatchForm(context) {
    for (const SceneListing& scene : builtinScenes()) scenes_.push_back(scene.id);
    for (const RecorderListing& recorder : builtinRecorders()) recorders_.push_back(recorder.id);
    options_.sources = {scenes_.front()};
    options_.scene.object_types = {types_.front()};
    options_.threads = std::max(1, availableCores() - 1);
  }

  void draw() {
    BackgroundBake& bake = session.jobs.get<BackgroundBake>();
    const BakeReport report = bake.report();
    const bool running = bake.running();
    if (drawStart(bake, "Bake in the background; existing recordings are kept",
                  "Stop; finished recordings are kept")) {
      update();
      started_ = session.notices.catchErrors([&] {
        if (!preview_.error.empty()) throw InputError(preview_.error);
        startBake(bake, options_, session.jobs.host);
      });
    }
    ImGui::BeginDisabled(running);
    drawOptions();
    ImGui::EndDisabled();
    if (stale_) update();
    // The items of a bake that has just finished replace the preview.
    const bool listed = started_ && report.state == TaskState::done;
    if (report.state != TaskState::idle) drawItems(report);
    if (!running && !listed) drawPreview();
  }

 private:
  /// The recordings that the inputs would bake.
  struct Preview {
    std::vector<std::pair<std::filesystem::path, std::uint64_t>> recordings;
    std::uint64_t bytes = 0;
    std::string error;  ///< in the inputs; "": none
  };

  /// Returns the options of a choice parameter of built-in scenes.
  static std::vector<std::string> optionsOf(std::string_view parameter) {
    std::vector<std::string> options;
    makeSimulation("freefall")->visitParameters([&](const Parameter& p) {
      if (Choice* const* choice = std::get_if<Choice*>(&p.value); choice && p.name == parameter) {
        options = (*choice)->options;
      }
    });
    return options;
  }

  /// Draws a checkbox for each of `all`; `chosen` are the checked ones.
  void drawCheckboxes(const char* name, const std::vector<std::string>& all,
                      std::vector<std::string>& chosen) {
    ui.heading(name);
    const auto scope = ui.scope(name);
    const float half = ImGui::GetContentRegionAvail().x / 2;
    int column = 0;
    for (const std::string& choice : all) {
      if (column++ % 2 == 1) ImGui::SameLine(half);
      bool marked = std::ranges::find(chosen, choice) != chosen.end();
      if (!ui.checkbox(choice.c_str(), marked)) continue;
      stale_ = true;
      if (marked) {
        chosen.push_back(choice);
      } else {
        std::erase(chosen, choice);
      }
    }
  }

  void drawOptions() {
    drawCheckboxes("scenes", scenes_, options_.sources);
    drawCheckboxes("object types", types_, options_.scene.object_types);
    drawCheckboxes("recorders", recorders_, options_.scene.recorders);
    ui.heading("Settings");
    stale_ |= ui.text("objects", counts_, "1000, 8000");
    ui.tooltip("Numbers of bodies, one recording each");
    stale_ |= ui.integer("frames", frames_, 1, 1'000'000, "Frames after the initial pose");
    stale_ |= ui.combo("engine", engine_, engines_, "Physics engine");
    std::int64_t threads = options_.threads;
    if (ui.integer("threads", threads, 1, 256, "Number of recordings to bake in parallel")) {
      options_.threads = static_cast<int>(threads);
    }
    drawFolder("output", "Folder for recordings", directory_, stale_);
  }

  /// Reads the inputs and makes the preview.
  void update() {
    stale_ = started_ = false;
    preview_ = {};
    try {
      if (options_.sources.empty()) throw InputError("no scene is chosen");
      if (options_.scene.object_types.empty()) throw InputError("no object type is chosen");
      if (directory_.empty()) throw InputError("an output folder is needed");
      options_.scene.objects = parseCounts(counts_, "number of bodies", kMaxBodies);
      if (options_.scene.objects.empty()) throw InputError("a number of bodies is needed");
      options_.scene.parameters = {{"frames", std::to_string(frames_)},
                                   {"engine", engines_.at(engine_)}};
      options_.record = directory_;
      BakeOptions all = options_;
      all.force = true;  // skips reading existing recordings
      const auto plan = planBake(all);
      preview_.bytes = plan->bytes();
      for (const BakeJob& job : plan->pending) {
        for (const std::filesystem::path& path : job.paths) {
          preview_.recordings.emplace_back(path, minBytes(path, job.scene));
        }
      }
    } catch (const InputError& error) {
      preview_.error = error.what();
    }
  }

  void drawItems(const BakeReport& report) {
    ui.heading(fmt::format("{}: {}", kTaskStates.nameOf(report.state), report.text()).c_str());
    const auto scope = ui.scope("recordings");
    for (const BakeReport::Item& item : report.items) {
      const bool exists = item.outcome == BakeOutcome::kept || item.outcome == BakeOutcome::baked;
      const std::string name = item.path.filename().string();
      ImGui::PushID(item.path.c_str());
      ImGui::BeginDisabled(!exists);
      const Rgb rgb = item.outcome == BakeOutcome::failed ? ui.theme.bad : ui.theme.good;
      if (ui.selectableLine(
              name.c_str(), false, kBakeOutcomes.nameOf(item.outcome), rgb,
              exists || item.failure.empty() ? "Open the recording" : item.failure.c_str())) {
        session.open(item.path);
      }
      ImGui::EndDisabled();
      ImGui::PopID();
    }
  }

  void drawPreview() const {
    if (!preview_.error.empty()) {
      ui.heading("To bake");
      ui.paragraph(preview_.error, ui.theme.warning);
      return;
    }
    ui.heading(fmt::format("To bake: {}, {}", counted(preview_.recordings.size(), "recording"),
                           bytesText(preview_.bytes))
                   .c_str());
    clipped(preview_.recordings.size(), [&](std::size_t row) {
      const auto& [path, bytes] = preview_.recordings[row];
      ui.line(path.filename().string(), bytesText(bytes), ui.theme.faint);
    });
  }

  std::vector<std::string> scenes_;
  std::vector<std::string> recorders_;
  const std::vector<std::string> types_ = optionsOf("object_type");
  const std::vector<std::string> engines_ = optionsOf("engine");
  BakeOptions options_;
  std::string counts_ = "1000";
  std::int64_t frames_ = 100;
  std::size_t engine_ = 0;
  std::string directory_ = "recordings";
  bool stale_ = true;     ///< the preview is outdated
  bool started_ = false;  ///< a bake with the current inputs was started
  Preview preview_;
};

}  // namespace broadmark
