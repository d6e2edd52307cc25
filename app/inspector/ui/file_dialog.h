// A file dialog inside the window.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "inspector/ui/ui.h"

namespace broadmark {

class FileDialog {
 public:
  enum class Purpose { open, save, directory };
  struct Request {
    std::string title;
    Purpose purpose = Purpose::open;
    std::vector<std::string> extensions = {};  ///< listed: ".aabbs"; empty: all
    std::filesystem::path suggestion = {};     ///< initial file or directory
    std::function<void(const std::filesystem::path&)> chosen;
  };

  /// Opens the dialog.
  void ask(Request request);
  [[nodiscard]] bool isOpen() const { return open_; }
  /// Draws the dialog if it is open, and calls `chosen` with the chosen path.
  void draw(Ui& ui);

 private:
  struct Entry {
    std::string name;
    bool is_directory = false;
    std::uintmax_t bytes = 0;
  };

  void enter(const std::filesystem::path& directory);
  void drawEntries(Ui& ui);
  void accept();
  /// Returns the file that saving to `path`, plus a missing extension, would overwrite; "": none.
  [[nodiscard]] std::filesystem::path overwrittenBy(const std::filesystem::path& path) const;

  Request request_;
  bool open_ = false;
  bool opening_ = false;
  bool confirm_overwrite_ = false;
  std::filesystem::path directory_;
  std::string path_text_;
  std::string name_;
  std::string failure_;
  std::vector<Entry> entries_;
};

}  // namespace broadmark
