#include "inspector/views/start_page.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "broadmark/pair.h"
#include "broadmark/reference_pairs.h"
#include "broadmark/render/ui_renderer.h"

namespace broadmark {
namespace {

constexpr float kMinTileWidth = 165;      // units
constexpr float kMaxPictureShare = 0.7F;  // of a tile's width
constexpr float kMinPictureHeight = 54;   // units
constexpr float kNearness = 0.75F;        // of the camera, which shows the whole world at 1
constexpr float kTurn = 0.006F;           // of the camera, in radians per frame

constexpr const char* kDrop =
    "A recording is played; a scene opens in the panel Author; the cases of results are listed; "
    "meshes, particles, arrays and CSV files are imported; a plug-in (.so) adds its algorithms. "
    "Ctrl+O also opens a file; Ctrl+P finds every command.";

}  // namespace

StartPage::Tile::Tile(const Gl& gl, const Example& example)
    : simulation(previewOf(example)), view(gl, {.threads = 1}) {
  const auto initial = simulation->rewind().boxes;
  boxes.assign(initial.begin(), initial.end());
  space = viewSpaceOf(shownBox(simulation->scene().world, boxes));
}

void StartPage::Tile::advance(bool dark) {
  const auto frame = simulation->next();
  const auto now = frame ? frame->boxes : simulation->rewind().boxes;
  boxes.assign(now.begin(), now.end());
  camera = orbited(camera, kTurn, 0);
  const std::vector<Pair> pairs = sweptPairs(boxes, simulation->scene().filter);
  const PairRun runs[] = {pairs};
  const std::vector<std::uint32_t> overlaps = overlapCounts(boxes.size(), runs);
  colourModes().front().colour({.boxes = boxes, .overlaps = overlaps, .dark = dark}, colouring);
  ++revision;
}

void StartPage::Tile::draw(int width, int height, const Ui& ui) {
  const double aspect = static_cast<double>(width) / height;
  const Aabb all = shownBox(simulation->scene().world, boxes);
  if (camera == OrbitCamera{}) camera = viewedFrom({}, Direction::figure);
  camera = focusedOn(camera, space.toView(all), aspect);
  camera.distance *= kNearness;
  view.resize(width, height);
  view.draw({.space = space,
             .world = simulation->scene().world,
             .bodies_revision = revision,
             .boxes = boxes,
             .colours = colouring.colours,
             .theme = ui.theme,
             .shows_world = false,
             .scale = ui.scale},
            camera);
}

void StartPage::update(const Session& session) {
  if (session.playback.source() != shown_instead_of_) wanted_ = false;
  if (!isShown(session)) tiles_.clear();
}

void StartPage::advance(const Session& session, bool dark, double seconds) {
  if (tiles_.empty()) {
    for (const Example& example : examples()) {
      tiles_.push_back(std::make_unique<Tile>(*gl_, example));
      tiles_.back()->advance(dark);
    }
    return;
  }
  // A batch may be measuring.
  if (session.jobs.running()) return;
  seconds_due_ += seconds;
  if (seconds_due_ < kFrameSeconds) return;
  seconds_due_ = 0;
  for (const auto& tile : tiles_) tile->advance(dark);
}

void StartPage::draw(Ui& ui, Session& session, const std::vector<Entry>& recovered,
                     const std::vector<Entry>& recent, double seconds) {
  const auto scope = ui.scope("Start");
  advance(session, ui.theme.panel == kDarkPalette.panel, seconds);
  if (!recovered.empty()) drawEntries(ui, "Not saved", recovered);
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const std::size_t listed = std::min<std::size_t>(recent.size(), 4);
  drawExamples(ui, session, line * (6 + static_cast<float>(listed)));
  if (!recent.empty()) drawEntries(ui, "Recent files", recent);
  ui.heading("Drop a file on the window");
  ui.faintParagraph(kDrop);
}

void StartPage::drawEntries(Ui& ui, const char* heading, const std::vector<Entry>& entries) {
  ui.heading(heading);
  const auto scope = ui.scope(heading);
  for (const Entry& entry : entries) {
    if (ui.selectableLine(entry.text.c_str(), false, "", ui.theme.faint, entry.tooltip.c_str())) {
      entry.open();
    }
  }
}

void StartPage::handleKeys(Session& session, std::size_t columns) {
  const bool elsewhere = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId) ||
                         ImGui::GetIO().WantTextInput || ImGui::GetIO().KeyCtrl ||
                         (ImGui::GetIO().ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard) != 0;
  if (elsewhere) return;
  const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
  const std::size_t count = examples().size();
  if (pressed(ImGuiKey_LeftArrow)) selected_ = (selected_ + count - 1) % count;
  if (pressed(ImGuiKey_RightArrow)) selected_ = (selected_ + 1) % count;
  if (pressed(ImGuiKey_UpArrow) && selected_ >= columns) selected_ -= columns;
  if (pressed(ImGuiKey_DownArrow) && selected_ + columns < count) selected_ += columns;
  if (Ui::entered()) openExample(session, examples()[selected_]);
}

void StartPage::drawExamples(Ui& ui, Session& session, float bottom) {
  ui.heading("Examples");
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = ImGui::GetContentRegionAvail().x;
  const std::size_t count = examples().size();
  std::size_t columns = 1;
  for (const std::size_t some : {2, 3}) {
    if (width >= static_cast<float>(some) * (kMinTileWidth * ui.scale + gap)) columns = some;
  }
  const std::size_t rows = (count + columns - 1) / columns;
  const float tile_width =
      std::floor((width - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns));
  const float text_height = 2 * ImGui::GetTextLineHeight() + 2 * gap;
  const float row_height = (ImGui::GetContentRegionAvail().y - bottom) / static_cast<float>(rows);
  const float room = row_height - text_height - gap;
  const float picture_height =
      std::floor(std::clamp(room, kMinPictureHeight * ui.scale, kMaxPictureShare * tile_width));
  handleKeys(session, columns);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % columns != 0) ImGui::SameLine();
    if (drawTile(ui, i, {tile_width, picture_height + text_height}, picture_height)) {
      selected_ = i;
      openExample(session, examples()[i]);
    }
  }
}

bool StartPage::drawTile(Ui& ui, std::size_t index, ImVec2 size, float picture_height) {
  const Example& example = examples()[index];
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::PushID(static_cast<int>(index));
  const bool pressed = ImGui::Button("##example", size);
  ImGui::PopID();
  ui.note(example.name);
  if (!ImGui::IsItemVisible()) return pressed;
  const ImVec2 from{corner.x + gap, corner.y + gap};
  const ImVec2 picture{std::max(size.x - 2 * gap, 1.0F), std::max(picture_height - gap, 1.0F)};
  Tile& tile = *tiles_[index];
  tile.draw(static_cast<int>(picture.x), static_cast<int>(picture.y), ui);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(uiTexture(tile.view.texture()), from, {from.x + picture.x, from.y + picture.y},
                {0, 1}, {1, 0});
  const float top = from.y + picture.y + gap / 2;
  list.AddText({from.x, top}, colour(ui.theme.text), fittingText(example.name, picture.x).c_str());
  const std::string doc = fittingText(example.doc, picture.x);
  list.AddText({from.x, top + ImGui::GetTextLineHeight()}, colour(ui.theme.faint), doc.c_str());
  if (doc != example.doc) ui.tooltip(example.doc);
  if (index == selected_) {
    list.AddRect(corner, {corner.x + size.x, corner.y + size.y}, colour(ui.theme.accent),
                 ImGui::GetStyle().FrameRounding, 0, 1.5F * ui.scale);
  }
  return pressed;
}

}  // namespace broadmark
