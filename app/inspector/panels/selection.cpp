// Properties of the selected bodies, and of the scene.

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/analysis/scene_statistics.h"
#include "inspector/panels/panel.h"
#include "inspector/session/text_lists.h"
#include "inspector/session/wrong_pair.h"
#include "support/words.h"

namespace broadmark::panels::selection {
namespace {

constexpr std::size_t kListedBodies = 200;
constexpr std::size_t kListedPartners = 200;

class SelectionPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    const Snapshot* snapshot = progress->snapshot.get();
    if (snapshot == nullptr) {
      ui.faintParagraph(
          "Nothing is open: press Simulate in the panel Scene, or open or drop a file.");
      return;
    }
    drawIdInput();
    if (session.selection.bodies().empty()) {
      drawScene(progress->snapshot);
    } else if (session.selection.bodies().size() == 1) {
      drawBody(*snapshot, session.selection.bodies().front());
    } else {
      drawBodies(*snapshot);
    }
  }

 private:
  void drawIdInput() {
    if (progress->scene.objects == 0) return;
    if (!ui.text("body", ids_text_, "17, 40-50")) return;
    session.notices.catchErrors([&] {
      session.selection.select(parseIds(ids_text_, "body", progress->scene.objects - 1));
      session.selection.flyToSelection();
    });
  }

  void drawBody(const Snapshot& snapshot, std::uint32_t body) {
    if (body >= snapshot.boxes->size()) return;
    const Aabb& box = (*snapshot.boxes)[body];
    ui.heading(fmt::format("Body {}", body).c_str());
    drawGroups(snapshot.scene.filter, body);
    if (isEmpty(box)) {
      const auto trail = std::ranges::find(snapshot.trails, body, &Trail::body);
      ui.paragraph(trail != snapshot.trails.end() ? absenceText(*trail) : "absent");
      return;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ui.valueRow(kAxes[axis], fmt::format("{:.5g} … {:.5g}", box.min[axis], box.max[axis]));
    }
    ui.valueRow("size", fmt::format("{:.4g} × {:.4g} × {:.4g}", box.max[0] - box.min[0],
                                    box.max[1] - box.min[1], box.max[2] - box.min[2]));
    ui.valueRow("overlaps", std::to_string(snapshot.overlaps[body]));
    if (snapshot.structure && body < snapshot.structure->tests().size()) {
      ui.valueRow("tests", std::to_string(snapshot.structure->tests()[body]));
    }
    ui.heading("Overlaps with");
    ImGui::BeginChild("partners", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
    std::size_t listed = 0;
    for (const Pair& pair : snapshot.pairs) {
      if (pair.a != body && pair.b != body) continue;
      if (listed++ == kListedPartners) break;
      const std::uint32_t other = pair.a == body ? pair.b : pair.a;
      if (ui.selectable(fmt::format("{}", other).c_str(), false)) session.selection.flyToPair(pair);
    }
    ImGui::EndChild();
  }

  void drawGroups(const CollisionFilter& filter, std::uint32_t body) {
    const BodyGroups groups = filter.groupsOf(body);
    if (!filter.layers().empty()) ui.valueRow("layer", std::to_string(groups.layer));
    if (!filter.worlds().empty()) ui.valueRow("world", std::to_string(groups.world));
    if (groups.tags == BodyGroups::kNoTags) return;
    std::string tags;
    for (const std::uint32_t tag : groups.tags) {
      if (tag != BodyGroups::kNoTag) tags += fmt::format("{}{}", tags.empty() ? "" : ", ", tag);
    }
    ui.valueRow("tags", tags);
  }

  void drawBodies(const Snapshot& snapshot) {
    const std::vector<std::uint32_t> bodies = session.selection.bodies();
    ui.heading(counted(bodies.size(), "body", "bodies").c_str());
    if (ui.button("Fly there", "Move the camera there (F)")) session.selection.flyToSelection();
    ImGui::BeginChild("bodies", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
    for (std::size_t i = 0; i < std::min(bodies.size(), kListedBodies); ++i) {
      if (bodies[i] >= snapshot.boxes->size()) continue;
      const std::string label = isEmpty((*snapshot.boxes)[bodies[i]])
                                    ? fmt::format("{}    absent", bodies[i])
                                    : fmt::format("{}    {}", bodies[i],
                                                  counted(snapshot.overlaps[bodies[i]], "overlap"));
      if (ui.selectable(label.c_str(), false)) session.selection.select({bodies[i]});
    }
    if (bodies.size() > kListedBodies) ui.faint("…");
    ImGui::EndChild();
  }

  /// The changes take a pass over all boxes: they are computed once per snapshot.
  void drawScene(const std::shared_ptr<const Snapshot>& snapshot) {
    ui.heading("Scene");
    ui.valueRow("name", snapshot->scene.name);
    ui.valueRow("object type", snapshot->scene.object_type);
    const bool changes = !snapshot->scene.all_present;
    ui.valueRow("bodies", changes
                              ? fmt::format("{} of {}", snapshot->present, snapshot->boxes->size())
                              : std::to_string(snapshot->present));
    ui.valueRow("pairs", std::to_string(snapshot->pairs.size()));
    const float side = snapshot->scene.world.max[0] - snapshot->scene.world.min[0];
    ui.valueRow("world", fmt::format("{:.4g} wide", side));
    if (changes_snapshot_ != snapshot) {
      changes_snapshot_ = snapshot;
      changes_ = {};
      if (snapshot->boxes_before) {
        changes_ = changesBetween(*snapshot->boxes_before, *snapshot->boxes);
      }
    }
    const auto count = [&](const char* name, double bodies) {
      ui.valueRow(name, fmt::format("{:.0f}", bodies));
    };
    count("moving", changes_.changed - changes_.appeared - changes_.vanished);
    if (changes) {
      count("appeared", changes_.appeared);
      count("vanished", changes_.vanished);
    }
    ImGui::Spacing();
    ui.faintParagraph("Click a body to select it; drag with Shift to select several.");
  }

  std::string ids_text_;
  std::shared_ptr<const Snapshot> changes_snapshot_;
  Changes changes_;  ///< in changes_snapshot_
};

}  // namespace

extern const PanelSpec spec = {"Bodies", DockArea::right,
                               "The selected bodies, and the scene as a whole",
                               make<SelectionPanel>};

}  // namespace broadmark::panels::selection
