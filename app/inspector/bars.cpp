// The bars below the view: playback and status.

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "inspector/inspector.h"
#include "inspector/session/answer_text.h"
#include "support/words.h"

namespace broadmark {
namespace {

constexpr float kOneRowWidth = 560;  // units: below, the playback has two rows
constexpr double kSpeeds[] = {1, 5, 10, 15, 24, 30, 60, 120, 1000};

/// Draws the progress of work on the status line, with a button if it can be cancelled there.
void drawWork(Ui& ui, float fraction, const std::string& activity, Job* cancellable = nullptr) {
  ImGui::SameLine(0, 14 * ui.scale);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x, 0});
  ImGui::ProgressBar(fraction, {90 * ui.scale, ImGui::GetTextLineHeight()}, "");
  ImGui::SameLine();
  ui.faint(activity);
  if (cancellable != nullptr) {
    ImGui::SameLine();
    if (ui.button("Cancel", "Stop; nothing is changed")) cancellable->cancel();
  }
  ImGui::PopStyleVar();
}

/// Draws the progress of a job of a file while it runs: "saving some.aabbs".
template <class JobType>
void drawFileJob(Ui& ui, const char* what, JobType& job) {
  const auto report = job.report();
  if (report.state != TaskState::running) return;
  drawWork(ui, report.fraction, fmt::format("{} {}", what, report.file.filename().string()), &job);
}

}  // namespace

float Inspector::transportHeight(float width) const {
  const float row = ImGui::GetFrameHeight();
  const bool narrow = width < kOneRowWidth * ui_.scale;
  return 12 * ui_.scale + (narrow ? 2 * row + ImGui::GetStyle().ItemSpacing.y : row);
}

void Inspector::drawTransport(const RunProgress& progress) {
  const auto scope = ui_.scope("Playback");
  const bool narrow = ImGui::GetWindowWidth() < kOneRowWidth * ui_.scale;
  ImGui::BeginDisabled(session_.playback.source() == nullptr);
  drawButtons();
  ImGui::SameLine();
  const auto draw_loop = [this] {
    ui_.toggle("Loop", session_.playback.loop, "Restart after the last frame");
    ImGui::SameLine();
  };
  if (!narrow) draw_loop();
  drawSpeed();
  if (!narrow) ImGui::SameLine();
  if (narrow) draw_loop();
  drawPosition(progress);
  ImGui::EndDisabled();
}

void Inspector::drawButtons() {
  Playback& playback = session_.playback;
  if (ui_.button("|<", "First frame (Home)")) playback.goTo(0);
  ImGui::SameLine();
  if (ui_.button("<", "Previous frame (Left)")) playback.step(-1);
  ImGui::SameLine();
  bool playing = playback.playing();
  if (ui_.toggle(playing ? "Pause###Play" : "Play###Play", playing, "Play or pause (Space)",
                 52 * ui_.scale)) {
    session_.play(playing);
  }
  ImGui::SameLine();
  if (ui_.button(">", "Next frame (Right)")) playback.step(1);
}

void Inspector::drawSpeed() {
  Playback& playback = session_.playback;
  std::vector<std::string> speeds;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < std::size(kSpeeds); ++i) {
    speeds.push_back(kSpeeds[i] >= 1000 ? "fastest" : fmt::format("{:g}/s", kSpeeds[i]));
    if (kSpeeds[i] <= playback.frames_per_second) chosen = i;
  }
  if (ui_.combo("##speed", chosen, speeds, "Maximum number of frames per second",
                std::min(90 * ui_.scale, ImGui::GetContentRegionAvail().x))) {
    playback.frames_per_second = kSpeeds[chosen];
  }
  // Reserve the space while paused, so that the layout does not change.
  constexpr float kWidth = 40;  // units
  const float room = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x -
                     ImGui::GetItemRectMax().x - ImGui::GetStyle().ItemSpacing.x;
  if (room < kWidth * ui_.scale) return;
  ImGui::SameLine();
  const float left = ImGui::GetCursorPosX();
  ImGui::AlignTextToFramePadding();
  const auto achieved = playback.achievedRate();
  const int digits = achieved.value_or(0) < 1 ? 2 : achieved.value_or(0) < 10 ? 1 : 0;
  ui_.faint(achieved ? fmt::format("{:.{}f}/s", *achieved, digits) : "");
  ui_.note("achieved");
  ui_.tooltip("Frames shown in the last second");
  ImGui::SameLine(left + kWidth * ui_.scale);
  ImGui::Dummy({0, 0});
}

void Inspector::drawPosition(const RunProgress& progress) {
  Playback& playback = session_.playback;
  const auto text = [](std::uint32_t frame, std::uint32_t last) {
    return fmt::format("{} / {}", frame, last);
  };
  const std::uint32_t last = playback.lastFrame();
  // Reserve the width of the largest frame number.
  const float width =
      ImGui::CalcTextSize(text(last, last).c_str()).x + ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - width, 20.0F));
  int frame = static_cast<int>(playback.frame());
  ImGui::BeginDisabled(last == 0);
  if (ui_.slider("##frame", frame, 0, std::max(1, static_cast<int>(last)))) {
    playback.goTo(frame);
  }
  ImGui::EndDisabled();
  // Mark the frames simulated so far.
  if (progress.live && progress.scene.frames > 0) {
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    const float available = min.x + (max.x - min.x) *
                                        static_cast<float>(progress.available_frames) /
                                        static_cast<float>(progress.scene.frames);
    ImGui::GetWindowDrawList()->AddRectFilled({min.x, max.y - 2 * ui_.scale}, {available, max.y},
                                              colour(ui_.theme.accent, 0.7F));
  }
  ImGui::SameLine();
  ImGui::TextUnformatted(text(playback.frame(), last).c_str());
}

void Inspector::drawStatus(const RunProgress& progress) {
  const auto scope = ui_.scope("Status");
  ImGui::SetCursorPosY(4 * ui_.scale);
  if (progress.source) {
    ui_.plain(sourceText(progress.source.get()));
    ui_.note("source");
    ImGui::SameLine(0, 14 * ui_.scale);
    const std::string bodies = counted(progress.scene.objects, "body", "bodies");
    const bool partial = !progress.scene.all_present && progress.snapshot;
    ui_.faint(fmt::format(
        "{} {}, {}", progress.scene.name, progress.scene.object_type,
        partial ? fmt::format("{} of {}", progress.snapshot->present, bodies) : bodies));
    if (progress.snapshot) {
      ImGui::SameLine(0, 14 * ui_.scale);
      ui_.faint(views_.first().answer().answer);
    }
  } else if (session_.playback.source()) {
    ui_.plain(sourceText(session_.playback.source().get()));
  } else {
    ui_.faint("Nothing is open: simulate a scene, or open or drop a file");
  }
  if (!progress.activity.empty()) drawWork(ui_, progress.fraction, progress.activity);
  drawFileJob(ui_, "reading", session_.jobs.get<BackgroundReading>());
  drawFileJob(ui_, "saving", session_.jobs.get<BackgroundSave>());
  const Message& message = session_.notices.status;
  if (message.text.empty()) return;
  const float right = ImGui::GetWindowContentRegionMax().x;
  const float left = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + 20 * ui_.scale;
  const std::string shown =
      fittingText(message.text.substr(0, message.text.find('\n')), std::max(right - left, 0.0F));
  ImGui::SameLine(std::max(left, right - ImGui::CalcTextSize(shown.c_str()).x));
  ui_.coloured(message.severity == Severity::error     ? ui_.theme.bad
               : message.severity == Severity::warning ? ui_.theme.warning
                                                       : ui_.theme.faint,
               shown);
}

}  // namespace broadmark
