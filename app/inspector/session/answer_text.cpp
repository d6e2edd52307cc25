#include "inspector/session/answer_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/pair.h"
#include "inspector/session/wrong_pair.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// The algorithm's id; with its parameters if another track runs the same algorithm.
std::string ownerName(const std::vector<TrackReport>& tracks, const TrackReport& track) {
  const std::string& id = track.spec.test_case.algorithm.id;
  const auto same_id = std::ranges::count_if(
      tracks, [&](const TrackReport& other) { return other.spec.test_case.algorithm.id == id; });
  return same_id > 1 ? caseName(track.spec.test_case) : id;
}

std::string differenceText(const FrameDifference& difference) {
  std::string text;
  for (const WrongKind& kind : kWrongKinds) {
    const std::uint64_t count = difference.*kind.count;
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kind.name);
  }
  return text;
}

void compareWithOracle(const Snapshot& snapshot, AnswerText& text) {
  if (!snapshot.checked) {
    text.verdict = AnswerText::Verdict::unchecked;
    text.comparison = "not compared with the oracle's answer";
    return;
  }
  const FrameDifference& difference = snapshot.difference;
  text.verdict = difference.isMismatch() ? AnswerText::Verdict::wrong : AnswerText::Verdict::right;
  const std::string details = differenceText(difference);
  text.comparison =
      details.empty() ? "the oracle finds the same"
                      : fmt::format("the oracle finds {}: {}", snapshot.oracle_pair_count, details);
}

std::string pairText(const Snapshot& snapshot, const std::string& owner,
                     std::span<const std::uint32_t> selection) {
  if (selection.size() != 2 || selection[1] >= snapshot.boxes->size()) return "";
  const Pair pair{selection[0], selection[1]};
  const std::vector<Aabb>& boxes = *snapshot.boxes;
  const bool right = overlaps(boxes[pair.a], boxes[pair.b], snapshot.scene.periodic) &&
                     snapshot.scene.filter.wanted(pair.a, pair.b);
  const char* oracle = right ? "finds it" : "does not find it";
  const std::string name = pairName(pair);
  if (owner.empty()) return fmt::format("{}: the oracle {}", name, oracle);
  const bool reported = std::ranges::find(snapshot.pairs, pair) != snapshot.pairs.end();
  return fmt::format("{}: {} {} it, the oracle {}", name, owner,
                     reported ? "reports" : "does not report", oracle);
}

}  // namespace

AnswerText answerText(const Snapshot& snapshot, const std::vector<TrackReport>& tracks, int chosen,
                      std::span<const std::uint32_t> selection) {
  AnswerText text;
  const std::string pairs = counted(snapshot.pairs.size(), "pair");
  if (const TrackReport* track = findTrack(tracks, snapshot.track)) {
    text.owner = ownerName(tracks, *track);
    text.answer = fmt::format("{} reports {}", text.owner, pairs);
    compareWithOracle(snapshot, text);
  } else {
    text.answer = fmt::format("the oracle finds {}", pairs);
    const TrackReport* requested = findTrack(tracks, chosen);
    if (requested != nullptr && hasFailed(*requested)) {
      text.comparison = fmt::format("{}: {}", ownerName(tracks, *requested), requested->reason);
      text.verdict = AnswerText::Verdict::wrong;
    } else if (requested != nullptr) {
      text.comparison = fmt::format("{} has no answer for frame {}", ownerName(tracks, *requested),
                                    snapshot.frame);
    } else if (!tracks.empty()) {
      text.comparison = "no algorithm's answer is shown";
    }
  }
  text.pair = pairText(snapshot, text.owner, selection);
  return text;
}

std::string sourceText(const FrameProviderRequest* source) {
  if (source == nullptr) return "";
  return fmt::format("{}: {}", kFrameOrigins.nameOf(source->origin), source->title);
}

}  // namespace broadmark
