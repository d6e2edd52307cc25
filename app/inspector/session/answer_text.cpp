#include "inspector/session/answer_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/pair.h"
#include "inspector/session/wrong_pair.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// Its id, with the parameters where another track has the same.
std::string ownerName(const std::vector<TrackReport>& tracks, const TrackReport& track) {
  const std::string& id = track.spec.test_case.algorithm.id;
  const auto alike = std::ranges::count_if(
      tracks, [&](const TrackReport& other) { return other.spec.test_case.algorithm.id == id; });
  return alike > 1 ? caseName(track.spec.test_case) : id;
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
    text.beside = "not compared with the oracle's answer";
    return;
  }
  const FrameDifference& difference = snapshot.difference;
  text.verdict = difference.isMismatch() ? AnswerText::Verdict::wrong : AnswerText::Verdict::right;
  const std::string details = differenceText(difference);
  text.beside = details.empty()
                    ? "the oracle finds the same"
                    : fmt::format("the oracle finds {}: {}", snapshot.right_pairs, details);
}

std::string pairText(const Snapshot& snapshot, const std::string& owner,
                     std::span<const std::uint32_t> selection) {
  if (selection.size() != 2 || selection[1] >= snapshot.boxes->size()) return "";
  const Pair pair{selection[0], selection[1]};
  const std::vector<Aabb>& boxes = *snapshot.boxes;
  const bool right =
      overlaps(boxes[pair.a], boxes[pair.b]) && snapshot.scene.filter.wanted(pair.a, pair.b);
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
  if (const TrackReport* track = trackOf(tracks, snapshot.track)) {
    text.owner = ownerName(tracks, *track);
    text.answer = fmt::format("{} reports {}", text.owner, pairs);
    compareWithOracle(snapshot, text);
  } else {
    text.answer = fmt::format("the oracle finds {}", pairs);
    const TrackReport* silent = trackOf(tracks, chosen);
    if (silent != nullptr) {
      text.beside =
          fmt::format("{} has no answer for frame {}", ownerName(tracks, *silent), snapshot.frame);
    } else if (!tracks.empty()) {
      text.beside = "no algorithm's answer is shown";
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
