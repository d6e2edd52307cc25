// Choosing a file, in the window itself.
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
    std::vector<std::string> extensions = {};  ///< shown ones, such as ".aabbs"; empty: all
    std::filesystem::path suggestion = {};     ///< a file, or the directory to begin in
    std::function<void(const std::filesystem::path&)> chosen;
  };

  /// Opens it.
  void ask(Request request);
  [[nodiscard]] bool isOpen() const { return open_; }
  /// Draws it, if open. `chosen` is called when the user has decided.
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
  /// What saving under this name, to which an extension may be added, would replace; "": nothing.
  [[nodiscard]] std::filesystem::path replacedBy(const std::filesystem::path& path) const;

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
