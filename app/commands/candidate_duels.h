// Measures the candidates of an advice on a recording.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/analysis/duel.h"
#include "broadmark/recordings/sub_recording.h"
#include "broadmark/results/results.h"
#include "compare/advice.h"
#include "request/hosts.h"

namespace broadmark::commands {

struct Candidate {
  Case test_case;
  double seconds = 0;       ///< mean time of a frame when it was screened
  double wall_seconds = 0;  ///< of a frame, with all that is not measured
};

std::string nameOf(const Candidate&);

/// What is minimised: the mean over the frames of their minimum times.
double costOf(const CaseResult& times);

/// All calls throw Cancelled once the user has interrupted the program.
class CandidateDuels {
 public:
  /// `progress` is called often, with what is being done. `hosts` and `recording` must outlive
  /// this.
  CandidateDuels(const HostOptions& hosts, IndexedFrames& recording,
                 std::function<void(const std::string&)> progress);

  /// Runs some frames of all candidates and leaves those worth a duel, the fastest first. No call
  /// may take long: what is killed is tried again only if the fastest takes nearly as long.
  void screen(std::vector<Candidate>& candidates);

  /// The minimum time of a duel, about.
  static double minSeconds(const std::vector<Candidate>&);

  /// Times of the candidates in a duel of about that many seconds, on as many frames as that
  /// allows; nullopt for one that failed.
  std::vector<std::optional<CaseResult>> measure(const std::vector<Candidate>&, double seconds);

  /// The frames of the last duel: "all frames (60), 5 times".
  [[nodiscard]] const std::string& framesText() const { return frames_text_; }
  /// The failures noted since the last call: "mine: mismatch: frame 3: 1 missed, …".
  std::vector<std::string> takeFailures() { return std::exchange(new_failures_, {}); }
  /// Whether any candidate has failed.
  [[nodiscard]] bool hasFailures() const { return !failed_.empty(); }

 private:
  Status runBriefly(Candidate&, IndexedFrames&, const Excerpt&, double limit);
  DuelResult fight(const std::vector<DuelSide>&, FrameSource&, double seconds);
  SubRecording part(const Excerpt&);
  void describe(const DuelResult&, const Excerpt&);
  void note(const std::string& name, Status, const std::string& reason);

  const HostOptions& hosts_;
  IndexedFrames& recording_;
  std::function<void(const std::string&)> progress_;
  ExecutorFactory make_executor_;
  Oracle oracle_;
  std::set<std::string> hopeless_;  ///< killed on a few frames, whatever the answer
  std::set<std::string> failed_;
  std::vector<std::string> new_failures_;
  std::string frames_text_;
};

}  // namespace broadmark::commands
