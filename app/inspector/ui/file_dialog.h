// A file dialog inside the window.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
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
    /// Instead of extensions: whether a file is listed, unless the user wants all.
    std::function<bool(const std::filesystem::path&)> listed = {};
    std::filesystem::path suggestion = {};  ///< initial file or directory
    std::function<void(const std::filesystem::path&)> chosen;
  };

  /// `folders`: the last folder by the title of a request; outlives this object.
  explicit FileDialog(std::map<std::string, std::string>& folders) : folders_(folders) {}

  /// Opens the dialog, in the last folder of this request unless a file to save is suggested.
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
  [[nodiscard]] bool isListed(const std::filesystem::path& file) const;
  void drawName(Ui& ui);
  void drawEntries(Ui& ui);
  void accept();
  /// Returns the file that saving to `path`, plus a missing extension, would overwrite; "": none.
  [[nodiscard]] std::filesystem::path overwrittenBy(const std::filesystem::path& path) const;

  std::map<std::string, std::string>& folders_;
  Request request_;
  bool open_ = false;
  bool opening_ = false;
  bool confirm_overwrite_ = false;
  bool lists_all_ = false;
  bool is_fresh_ = false;  ///< the name has the focus, but nothing was typed or pressed yet
  std::filesystem::path directory_;
  std::string path_text_;
  std::string name_;
  std::string failure_;
  std::vector<Entry> entries_;
};

}  // namespace broadmark
