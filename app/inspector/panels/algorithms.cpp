// Choosing algorithms, and how each is run.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "inspector/panels/panel.h"

#include <imgui_stdlib.h>  // after imgui.h, which it lacks

namespace broadmark::panels::algorithms {
namespace {

constexpr float kListWidth = 260;   // units, of the list of algorithms to add
constexpr float kListHeight = 360;  // units, of that list

/// A family's algorithms, to choose from.
struct Family {
  std::string name;
  std::vector<const Algorithm*> members;
};

std::vector<Family> familiesOf(const std::vector<Algorithm>& algorithms) {
  std::vector<Family> families;
  for (const Algorithm& algorithm : algorithms) {
    auto family = std::ranges::find(families, algorithm.family, &Family::name);
    if (family == families.end()) {
      family = families.insert(families.end(), {algorithm.family, {}});
    }
    family->members.push_back(&algorithm);
  }
  return families;
}

class AlgorithmsPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    if (wideButton("Add…##add", "Adds an algorithm")) ImGui::OpenPopup("add");
    drawChoice();
    ui.checkbox("check every answer", session.mismatches.check,
                "Compares every answer with the oracle's, outside the timed region");
    ui.checkbox("stop at a mismatch", session.mismatches.stop_at_mismatch,
                "Stays at the first frame in which an algorithm is wrong",
                session.mismatches.check);
    if (session.tracks.list.empty()) {
      ImGui::Spacing();
      ui.paragraph("No algorithm is chosen: overlaps are the oracle's.");
    }
    int removed = 0;
    for (TrackEdit& track : session.tracks.list) {
      if (!drawTrack(track)) removed = track.number;
    }
    if (removed != 0) session.tracks.remove(removed);
  }

 private:
  /// A click takes one; with Ctrl several are marked, and then added at once.
  void drawChoice() {
    if (!ImGui::BeginPopup("add")) return;
    const auto scope = ui.scope("add");
    if (ImGui::IsWindowAppearing()) {
      searched_.clear();
      marked_.clear();
      ImGui::SetKeyboardFocusHere();
    }
    ImGui::SetNextItemWidth(kListWidth * ui.scale);
    ImGui::InputTextWithHint("##search", "search", &searched_);
    ui.note("search");
    const bool add =
        ui.button(fmt::format("Add {}###Add marked", marked_.size()).c_str(),
                  "Adds those that were marked by a click with Ctrl", 0, !marked_.empty());
    std::vector<std::string> chosen;
    if (add) chosen = marked_;
    ImGui::BeginChild("list", {kListWidth * ui.scale, kListHeight * ui.scale}, false,
                      ImGuiWindowFlags_NavFlattened);
    for (const Family& family : familiesOf(session.tracks.algorithms())) {
      drawFamily(family, chosen);
    }
    ImGui::EndChild();
    for (const std::string& id : chosen) session.tracks.add(id);
    if (!chosen.empty()) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }

  void drawFamily(const Family& family, std::vector<std::string>& chosen) {
    bool headed = false;
    for (const Algorithm* algorithm : family.members) {
      const std::string& id = algorithm->id;
      if (id.find(searched_) == id.npos && family.name.find(searched_) == id.npos) continue;
      if (!std::exchange(headed, true)) ui.faint(family.name);
      const auto mark = std::ranges::find(marked_, id);
      const bool pressed = ImGui::Selectable(id.c_str(), mark != marked_.end(),
                                             ImGuiSelectableFlags_DontClosePopups);
      ui.note(id);
      ui.tooltip(algorithm->summary.c_str());
      if (!pressed) continue;
      if (!ImGui::GetIO().KeyCtrl) {
        chosen = {id};
      } else if (mark == marked_.end()) {
        marked_.push_back(id);
      } else {
        marked_.erase(mark);
      }
    }
  }

  /// Returns whether it is to be kept.
  bool drawTrack(TrackEdit& track) {
    const std::string& id = track.test_case.algorithm.id;
    const auto scope = ui.scope(id);
    ImGui::PushID(track.number);
    bool keep = true;
    const bool open = ImGui::CollapsingHeader(id.c_str(), &keep, ImGuiTreeNodeFlags_DefaultOpen);
    ui.note("header");
    ui.tooltip(track.test_case.algorithm.summary.c_str());
    if (open) {
      bool changed = false;
      bool shown = session.tracks.shown() == track.number;
      if (ui.checkbox("show its answer", shown, "The view shows what this algorithm reports")) {
        session.tracks.show(shown ? track.number : 0);
      }
      changed |= drawExecution(track.test_case);
      changed |= ui.parameters(*track.parameters);
      if (changed) session.tracks.changed();
      if (ui.button("Remove")) keep = false;
    }
    ImGui::PopID();
    return keep;
  }

  bool drawExecution(Case& test_case) {
    bool changed = false;
    if (test_case.algorithm.traits.vectorised) {
      const std::vector<Isa> isas = supportedIsas();
      std::vector<std::string> names;
      for (const Isa isa : isas) names.emplace_back(isaName(isa));
      auto chosen = static_cast<std::size_t>(std::ranges::find(isas, test_case.isa) - isas.begin());
      if (ui.combo("isa", chosen, names, "Instruction set of its kernels")) {
        test_case.isa = isas[chosen];
        changed = true;
      }
    }
    if (test_case.algorithm.traits.parallel) {
      std::int64_t threads = test_case.threads;
      if (ui.integer("threads", threads, 1, 256, "Threads that share the work")) {
        test_case.threads = static_cast<int>(threads);
        changed = true;
      }
    }
    return changed;
  }

  std::string searched_;             ///< part of an id or a family's name
  std::vector<std::string> marked_;  ///< ids
};

}  // namespace

extern const PanelKind kind = {"Algorithms", DockArea::left,
                               "Which algorithms run, and with which parameters",
                               make<AlgorithmsPanel>};

}  // namespace broadmark::panels::algorithms
