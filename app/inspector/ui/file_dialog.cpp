#include "inspector/ui/file_dialog.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "broadmark/names.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

constexpr NameTable kVerbs{{NamedValue{FileDialog::Purpose::open, "Open"},
                            {FileDialog::Purpose::save, "Save"},
                            {FileDialog::Purpose::directory, "Choose"}}};

}  // namespace

void FileDialog::ask(Request request) {
  request_ = std::move(request);
  open_ = opening_ = true;
  confirm_overwrite_ = false;
  const fs::path& suggestion = request_.suggestion;
  std::error_code none;
  const bool is_directory = fs::is_directory(suggestion, none);
  name_ = is_directory ? "" : suggestion.filename().string();
  fs::path start = is_directory ? suggestion : suggestion.parent_path();
  const auto last = folders_.find(request_.title);
  if (last != folders_.end() && (start.empty() || request_.purpose == Purpose::open)) {
    if (last->second != start) name_ = request_.purpose == Purpose::open ? "" : name_;
    start = last->second;
  }
  enter(start.empty() || !fs::is_directory(start, none) ? fs::current_path(none) : start);
}

void FileDialog::enter(const fs::path& directory) {
  failure_.clear();
  entries_.clear();
  std::error_code error;
  directory_ = fs::absolute(directory, error).lexically_normal();
  path_text_ = directory_.string();
  for (fs::directory_iterator it(directory_, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code unknown;
    Entry entry{.name = it->path().filename().string(), .is_directory = it->is_directory(unknown)};
    if (entry.name.starts_with('.')) continue;
    if (!entry.is_directory && !isListed(it->path())) continue;
    if (!entry.is_directory) entry.bytes = it->file_size(unknown);
    entries_.push_back(std::move(entry));
  }
  if (error) failure_ = fmt::format("{}: {}", directory_.string(), error.message());
  std::ranges::sort(entries_, [](const Entry& a, const Entry& b) {
    return a.is_directory != b.is_directory ? a.is_directory : a.name < b.name;
  });
}

bool FileDialog::isListed(const fs::path& file) const {
  if (request_.purpose == Purpose::directory) return false;
  if (lists_all_) return true;
  if (request_.listed) return request_.listed(file);
  return request_.extensions.empty() ||
         std::ranges::find(request_.extensions, file.extension().string()) !=
             request_.extensions.end();
}

fs::path FileDialog::overwrittenBy(const fs::path& path) const {
  std::error_code none;
  if (fs::exists(path, none)) return path;
  for (const std::string& extension : request_.extensions) {
    fs::path extended = path.string() + extension;
    if (!path.has_extension() && fs::exists(extended, none)) return extended;
  }
  return {};
}

void FileDialog::accept() {
  const fs::path path =
      request_.purpose == Purpose::directory ? directory_ / name_ : directory_ / fs::path(name_);
  std::error_code none;
  if (request_.purpose != Purpose::directory) {
    if (name_.empty()) {
      failure_ = "enter a file name";
      return;
    }
    if (fs::is_directory(path, none)) {
      name_.clear();
      enter(path);
      return;
    }
    if (request_.purpose == Purpose::open && !fs::exists(path, none)) {
      failure_ = fmt::format("{}: no such file", path.string());
      return;
    }
    if (const fs::path existing = overwrittenBy(path);
        request_.purpose == Purpose::save && !existing.empty() && !confirm_overwrite_) {
      confirm_overwrite_ = true;
      failure_ = fmt::format("{} exists: press again to replace it", existing.filename().string());
      return;
    }
  }
  open_ = false;
  folders_[request_.title] = directory_.string();
  request_.chosen(path.lexically_normal());
}

void FileDialog::drawEntries(Ui& ui) {
  const float below = ImGui::GetFrameHeightWithSpacing() * 3.2F;
  ImGui::BeginChild("entries", {0, -below}, true, ImGuiWindowFlags_NavFlattened);
  if (directory_.has_relative_path() && ui.selectable("..", false)) enter(directory_.parent_path());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry entry = entries_[i];  // a copy: enter() replaces entries_
    const std::string label = entry.is_directory ? entry.name + "/" : entry.name;
    const bool pressed = entry.is_directory
                             ? ui.selectable(label.c_str(), false)
                             : ui.selectableLine(label.c_str(), entry.name == name_,
                                                 bytesText(entry.bytes), ui.theme.faint);
    if (!pressed) continue;
    if (entry.is_directory) {
      enter(directory_ / entry.name);
      break;
    }
    name_ = entry.name;
    confirm_overwrite_ = false;
    if (ImGui::IsMouseDoubleClicked(0)) accept();
  }
  ImGui::EndChild();
}

void FileDialog::drawName(Ui& ui) {
  // A file to save is named at once.
  if (ImGui::IsWindowAppearing()) is_fresh_ = request_.purpose == Purpose::save;
  if (ImGui::IsWindowAppearing() && is_fresh_) ImGui::SetKeyboardFocusHere();
  const std::string before = name_;
  if (ui.text("name", name_, "file name", ImGuiInputTextFlags_AutoSelectAll)) {
    confirm_overwrite_ = false;
  }
  if (name_ != before || ImGui::IsMouseClicked(0)) is_fresh_ = false;
  if (request_.purpose != Purpose::open || (request_.extensions.empty() && !request_.listed))
    return;
  ImGui::SameLine();
  if (ui.checkbox("all files", lists_all_, "List files of other kinds, too")) enter(directory_);
}

void FileDialog::draw(Ui& ui) {
  if (!open_) return;
  const auto scope = ui.scope("File");
  if (std::exchange(opening_, false)) ImGui::OpenPopup(request_.title.c_str());
  bool keep = true;
  if (!ui.beginDialog(request_.title.c_str(), {620, 460}, &keep)) {
    open_ = false;
    return;
  }
  ImGui::SetNextItemWidth(-1);
  ImGui::PushID("directory");
  const bool typed = ui.text("##directory", path_text_, "folder");
  const bool in_directory = ImGui::IsItemActive() || ImGui::IsItemDeactivated();
  ImGui::PopID();
  if (typed) enter(path_text_);
  drawEntries(ui);
  // Escape cancels typing first; a name that was only suggested is not being typed.
  if (is_fresh_ && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) keep = false;
  if (request_.purpose != Purpose::directory) drawName(ui);
  if (!failure_.empty()) {
    ui.coloured(confirm_overwrite_ ? ui.theme.warning : ui.theme.bad, failure_);
  } else {
    ImGui::Dummy({0, ImGui::GetTextLineHeight()});
  }
  // Ignores the Enter press that opened the dialog.
  const bool returned = Ui::entered() && !in_directory && !ImGui::IsWindowAppearing();
  const bool pressed = ui.button(std::string(kVerbs.nameOf(request_.purpose)).c_str());
  if (pressed || returned) accept();
  ImGui::SameLine();
  if (ui.cancel()) keep = false;
  if (!keep) open_ = false;
  if (!open_) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

}  // namespace broadmark
