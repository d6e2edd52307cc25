// Opens files of all kinds, cases of results, and plans.
#pragma once

#include <filesystem>
#include <string>

#include "inspector/jobs/case_export.h"
#include "inspector/session/opened_results.h"
#include "run/plan.h"

namespace broadmark {

class Session;

class Opener {
 public:
  /// `session` shows what is opened, and outlives it.
  explicit Opener(Session& session) : to_(session) {}

  /// Opens a file of any kind that openSource() knows. A bad one becomes an error. Of a results
  /// file all cases are listed; of a file that names a case, that becomes the only lane.
  void open(const std::filesystem::path& path);
  /// Opens the first entry with its cases as lanes, or lists those of results; without either
  /// there are only lanes. Throws InputError.
  void open(Plan plan);
  /// Opens a case of a results file at the first frame in which it is wrong. A bad one becomes an
  /// error.
  void openCase(const std::filesystem::path& file, const std::string& id);
  /// Opens a row of the listed results in the same way. Why it cannot be opened is kept there, and
  /// said.
  void openCase(OpenedResults::Row& row);
  /// Opens what has been exported, at the wrong frame.
  void openExport(const ExportReport& report);

 private:
  /// How an authored scene is shown first.
  enum class Opened { at_rest, in_motion };
  void openEntry(PlanEntry entry, Opened document_is);
  void enter(PlanEntry& entry, Opened document_is);
  void enterSource(PlanEntry& entry, Opened document_is);
  void listCases(const std::filesystem::path& file, Results listed);

  Session& to_;
};

}  // namespace broadmark
