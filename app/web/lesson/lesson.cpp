// The figures of the lesson page: algorithms that run, frame by frame, on boxes that the page
// moves.

#include <emscripten.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/algorithms.h"
#include "broadmark/change_detector.h"
#include "broadmark/recorded_drawing.h"

namespace broadmark {
namespace {

/// An algorithm on the boxes of a figure.
class Figure {
 public:
  Figure(const Algorithm& algorithm, const ParameterValues& parameters, std::uint32_t bodies)
      : scene_{.name = "Lesson",
               .object_type = "Boxes",
               .objects = bodies,
               .frames = std::numeric_limits<std::int32_t>::max(),
               .world = kWorld},
        boxes_(bodies, kWorld),
        instance_(algorithm.create()) {
    setParameters(*instance_, parameters);
  }

  /// The boxes, which the page moves.
  [[nodiscard]] std::vector<Aabb>& boxes() { return boxes_; }

  /// Runs a frame. Returns the answer, the structure and the work done as JSON.
  std::string run() {
    if (index_ == 0) {
      const Frame first = changes_.complete({.index = 0, .boxes = boxes_});
      instance_->initialize(scene_, first, execution_);
    }
    instance_->updateObjects(changes_.complete({.index = ++index_, .boxes = boxes_}));
    instance_->cleanCache();
    instance_->updateStructures();
    instance_->searchOverlaps();
    return json();
  }

 private:
  static constexpr Aabb kWorld{{0, 0, 0, 0}, {16, 10, 1, 0}};

  [[nodiscard]] std::string json() const {
    std::vector<std::string> pairs;
    for (const PairRun run : instance_->overlaps()) {
      for (const Pair pair : run) pairs.push_back(fmt::format("[{},{}]", pair.a, pair.b));
    }
    RecordedDrawing drawing(boxes_.size());
    instance_->drawStructure(drawing);
    std::vector<std::string> cells;
    for (const RecordedDrawing::Box& cell : drawing.boxes()) {
      cells.push_back(fmt::format("[{:.4g},{:.4g},{:.4g},{:.4g},{},{},{}]", cell.box.min[0],
                                  cell.box.min[1], cell.box.max[0], cell.box.max[1],
                                  static_cast<int>(cell.role), cell.level, cell.population));
    }
    std::vector<std::string> lines;
    for (const RecordedDrawing::Segment& line : drawing.lines()) {
      lines.push_back(fmt::format("[{:.4g},{:.4g},{:.4g},{:.4g},{}]", line.from[0], line.from[1],
                                  line.to[0], line.to[1], static_cast<int>(line.role)));
    }
    std::vector<std::string> counters;
    instance_->visitCounters([&](std::string_view name, std::uint64_t count) {
      counters.push_back(fmt::format("\"{}\":{}", name, count));
    });
    return fmt::format(
        R"({{"pairs":[{}],"cells":[{}],"lines":[{}],"tests":[{}],"counters":{{{}}}}})",
        fmt::join(pairs, ","), fmt::join(cells, ","), fmt::join(lines, ","),
        fmt::join(drawing.tests(), ","), fmt::join(counters, ","));
  }

  SceneInfo scene_;
  std::vector<Aabb> boxes_;
  ExecutionContext execution_{1, bestIsa()};
  std::unique_ptr<BroadPhase> instance_;
  ChangeDetector changes_;
  std::uint32_t index_ = 0;
};

std::vector<std::unique_ptr<Figure>>& figures() {
  static std::vector<std::unique_ptr<Figure>> list;
  return list;
}

}  // namespace
}  // namespace broadmark

extern "C" {

/// Starts an algorithm with parameters, "KEY=VALUE,…", on this many boxes, in place of the figure's
/// former one. Returns the boxes, eight floats each, valid until the next call for this figure;
/// null: no such algorithm.
EMSCRIPTEN_KEEPALIVE float* lessonStart(std::size_t figure, const char* id, const char* parameters,
                                        std::uint32_t bodies) {
  using namespace broadmark;
  const std::vector<Algorithm> known = builtinAlgorithms();
  const auto algorithm = std::ranges::find(known, id, &Algorithm::id);
  if (algorithm == known.end()) return nullptr;
  ParameterValues values;
  for (std::string_view rest = parameters; !rest.empty();) {
    const std::string_view part = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    const std::size_t split = part.find('=');
    values.emplace(part.substr(0, split), part.substr(split + 1));
  }
  if (figures().size() <= figure) figures().resize(figure + 1);
  figures()[figure] = std::make_unique<Figure>(*algorithm, values, bodies);
  return figures()[figure]->boxes().front().min.data();
}

/// Runs a frame of a figure on its boxes as they are now. Returns JSON, valid until the next call.
EMSCRIPTEN_KEEPALIVE const char* lessonFrame(std::size_t figure) {
  static std::string json;
  json = broadmark::figures().at(figure)->run();
  return json.c_str();
}
}
