// Selection and configuration of the algorithms.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "inspector/panels/panel.h"

#include <imgui_stdlib.h>  // requires imgui.h

namespace broadmark::panels::algorithms {
namespace {

// The list of algorithms to add, in units.
constexpr float kListWidth = 260;
constexpr float kListHeight = 360;

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
    if (wideButton("Add…##add", "Add an algorithm")) ImGui::OpenPopup("add");
    drawChoice();
    ui.checkbox("check every answer", session.mismatches.check,
                "Compare every answer with the oracle's, outside the timed region");
    ui.checkbox("stop at a mismatch", session.mismatches.stop_at_mismatch,
                "Stop at the first frame in which an algorithm is wrong", session.mismatches.check);
    if (session.tracks.list.empty()) {
      ImGui::Spacing();
      ui.paragraph("No algorithm is chosen: the overlaps are the oracle's.");
    }
    int removed = 0;
    for (TrackEdit& track : session.tracks.list) {
      if (!drawTrack(track)) removed = track.number;
    }
    if (removed != 0) session.tracks.remove(removed);
  }

 private:
  /// A click adds an algorithm; Ctrl+click marks several, which a button adds at once.
  void drawChoice() {
    if (!ImGui::BeginPopup("add")) return;
    const auto scope = ui.scope("add");
    if (ImGui::IsWindowAppearing()) {
      search_.clear();
      marked_.clear();
      ImGui::SetKeyboardFocusHere();
    }
    ImGui::SetNextItemWidth(kListWidth * ui.scale);
    ImGui::InputTextWithHint("##search", "search", &search_);
    ui.note("search");
    const bool add = ui.button(fmt::format("Add {}###Add marked", marked_.size()).c_str(),
                               "Add the algorithms marked by Ctrl+click", 0, !marked_.empty());
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
    bool has_heading = false;
    for (const Algorithm* algorithm : family.members) {
      const std::string& id = algorithm->id;
      if (id.find(search_) == id.npos && family.name.find(search_) == id.npos) continue;
      if (!std::exchange(has_heading, true)) ui.faint(family.name);
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

  /// Returns whether to keep the track.
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
      if (ui.checkbox("show its answer", shown, "Show this algorithm's answer in the view")) {
        session.tracks.show(shown ? track.number : 0);
      }
      changed |= drawExecution(track.test_case);
      changed |= ui.parameters(*track.parameters);
      if (changed) session.tracks.applyEdits();
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
      if (ui.combo("isa", chosen, names, "Instruction set of the algorithm's kernels")) {
        test_case.isa = isas[chosen];
        changed = true;
      }
    }
    if (test_case.algorithm.traits.parallel) {
      std::int64_t threads = test_case.threads;
      if (ui.integer("threads", threads, 1, 256, "Number of threads")) {
        test_case.threads = static_cast<int>(threads);
        changed = true;
      }
    }
    return changed;
  }

  std::string search_;               ///< part of an id or family name
  std::vector<std::string> marked_;  ///< ids
};

}  // namespace

extern const PanelSpec spec = {"Algorithms", DockArea::left, "Choose and configure algorithms",
                               make<AlgorithmsPanel>};

}  // namespace broadmark::panels::algorithms
