#include "imports/text_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/exact_sum.h"
#include "broadmark/recordings/periodic_frames.h"
#include "broadmark/scenes/simulation.h"
#include "imports/files.h"

namespace broadmark::imports {
namespace {

constexpr float kMaxFloat = std::numeric_limits<float>::max();

double radiusOf(const LineReader& lines, const std::vector<std::string_view>& words,
                const ParticleColumns& columns, double stated) {
  if (stated > 0) return stated;
  if (!columns.radius) lines.fail(columns.no_radius);
  const double size = lines.realNumber(words[*columns.radius], "the radius");
  if (size < 0) lines.fail(fmt::format("the radius {:g} is negative", size));
  return columns.is_diameter ? size / 2 : size;
}

class TextFrames final : public IndexedFrames {
 public:
  TextFrames(const std::vector<std::filesystem::path>& files, std::unique_ptr<TextFormat> format,
             std::string object_type, const ReadingOptions& options, ImportSummary& summary)
      : files_(files), format_(std::move(format)) {
    scene_.name = sequenceName(files);
    scene_.object_type = std::move(object_type);
    scene_.world = kEmptyBox;
    for (std::size_t file = 0; file < files.size(); ++file) scan(file, options);
    if (isEmpty(scene_.world)) scene_.world = {};
    scene_.objects = static_cast<std::uint32_t>(ids_.size());
    scene_.frames = static_cast<std::uint32_t>(locations_.size() - 1);
    scene_.periodic = format_->periodic();
    boxes_.resize(ids_.size());
    setFilter();
    summarise(summary);
  }

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  /// Location of a frame.
  struct FrameLocation {
    std::size_t file = 0;
    LineReader::Position position;
    bool empty = false;  ///< skipped frame number: all bodies are absent
  };

  void scan(std::size_t file, const ReadingOptions& options) {
    LineReader lines(files_[file]);
    lines.watch([&](double fraction) {
      options.report((static_cast<double>(file) + fraction) / static_cast<double>(files_.size()));
    });
    format_->start(lines);
    const std::size_t before = locations_.size();
    while (true) {
      const FrameLocation location{.file = file, .position = lines.position()};
      if (!readNext(lines)) break;
      addFrame(lines, location);
      addBodies(lines);
    }
    if (locations_.size() == before) {
      throw InputError(fmt::format("{}: holds no frame", files_[file].string()));
    }
  }

  /// Reads a frame into frame_. Returns false at the end of the file.
  bool readNext(LineReader& lines) {
    frame_.number.reset();
    frame_.time.reset();
    frame_.has_ids = true;
    frame_.rows.clear();
    return format_->read(lines, frame_);
  }

  void addFrame(const LineReader& lines, FrameLocation location) {
    std::uint64_t skipped = 0;
    if (frame_.number && last_number_) {
      if (*frame_.number <= *last_number_) {
        lines.fail(frame_.rows.front().line,
                   fmt::format("frame {} after frame {}: frames must be in ascending order",
                               *frame_.number, *last_number_));
      }
      skipped = static_cast<std::uint64_t>(*frame_.number) -
                static_cast<std::uint64_t>(*last_number_) - 1;
    }
    last_number_ = frame_.number;
    if (frame_.time && last_time_ && !(*frame_.time > *last_time_)) {
      lines.fail(frame_.rows.front().line,
                 fmt::format("time {} after time {}: frames must be in ascending order",
                             *frame_.time, *last_time_));
    }
    last_time_ = frame_.time;
    if (!locations_.empty() && frame_.has_ids != has_ids_) {
      lines.fail("only some frames have ids: all or none are expected");
    }
    has_ids_ = frame_.has_ids;
    if (skipped >= kMaxFrames || locations_.size() + skipped > kMaxFrames) {
      lines.fail(frame_.rows.empty() ? lines.number() : frame_.rows.front().line,
                 fmt::format("more than {} frames", kMaxFrames));
    }
    if (skipped > 0) scene_.all_present = false;
    locations_.resize(locations_.size() + skipped, FrameLocation{.empty = true});
    locations_.push_back(location);
  }

  /// Adds the new bodies of a frame, and extends the world.
  void addBodies(const LineReader& lines) {
    std::vector<TextRow>& rows = frame_.rows;
    if (!std::ranges::is_sorted(rows, {}, &TextRow::id)) {
      std::ranges::stable_sort(rows, {}, &TextRow::id);
    }
    const auto duplicate = std::ranges::adjacent_find(rows, {}, &TextRow::id);
    if (duplicate != rows.end()) {
      lines.fail(std::next(duplicate)->line, fmt::format("{} is already in this frame, in line {}",
                                                         duplicate->id, duplicate->line));
    }
    for (const TextRow& row : rows) {
      scene_.world = merged(scene_.world, row.box);
      addLayer(lines, row);
    }
    const auto same_id = [](const TextRow& row, std::int64_t id) { return row.id == id; };
    if (std::ranges::equal(rows, ids_, same_id)) return;
    if (locations_.size() > 1) scene_.all_present = false;
    std::vector<std::int64_t> all;
    std::vector<std::int64_t> present;
    for (const TextRow& row : rows) present.push_back(row.id);
    std::ranges::set_union(ids_, present, std::back_inserter(all));
    if (all.size() > std::numeric_limits<std::int32_t>::max())
      lines.fail("more bodies than 2^31 - 1");
    ids_ = std::move(all);
  }

  void addLayer(const LineReader& lines, const TextRow& row) {
    if (has_layers_.value_or(row.layer.has_value()) != row.layer.has_value()) {
      lines.fail(row.line, "only some files have layers: all or none are expected");
    }
    has_layers_ = row.layer.has_value();
    if (!row.layer) return;
    const auto known = layers_.try_emplace(row.id, *row.layer).first;
    if (known->second == *row.layer) return;
    lines.fail(row.line, fmt::format("{} is in layer {}, before in {}: a body's layer is fixed",
                                     row.id, *row.layer, known->second));
  }

  void setFilter() {
    std::vector<BodyGroups> groups(layers_.empty() ? 0 : ids_.size());
    for (std::size_t body = 0; body < groups.size(); ++body) {
      groups[body].layer = layers_.at(ids_[body]);
    }
    if (!groups.empty()) scene_.filter = CollisionFilter(groups, LayerMatrix::all());
  }

  void summarise(ImportSummary& summary) const {
    const std::string format = summary.format;
    summary = format_->summary();
    summary.format = format;
    if (has_ids_ || locations_.size() == 1) return;
    const bool varies = !scene_.all_present;
    const std::string order =
        fmt::format("no ids: bodies are identified by their order in a frame{}",
                    varies ? ", and their number varies" : "");
    addOnce(varies || !format_->keepsOrder() ? summary.warnings : summary.used, order);
  }

  LineReader& reader(std::size_t file) {
    if (!reader_ || reader_file_ != file) {
      reader_.emplace(files_[file]);
      format_->start(*reader_);
    }
    reader_file_ = file;
    return *reader_;
  }

  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    const FrameLocation& location = locations_[index];
    std::ranges::fill(boxes_, kEmptyBox);
    if (location.empty) return boxes_;
    LineReader& lines = reader(location.file);
    lines.seek(location.position);
    if (!readNext(lines)) lines.fail("the file has changed: its frames are no longer there");
    for (const TextRow& row : frame_.rows) {
      const auto body = std::ranges::lower_bound(ids_, row.id);
      if (body == ids_.end() || *body != row.id) lines.fail("the file has changed: a new id");
      boxes_[static_cast<std::size_t>(body - ids_.begin())] = row.box;
    }
    return boxes_;
  }

  std::vector<std::filesystem::path> files_;
  std::unique_ptr<TextFormat> format_;
  SceneInfo scene_;
  std::vector<FrameLocation> locations_;
  std::vector<std::int64_t> ids_;  ///< ascending, by body
  std::optional<LineReader> reader_;
  std::size_t reader_file_ = 0;
  TextFrame frame_;
  std::optional<std::int64_t> last_number_;  ///< of the previous frame
  std::optional<double> last_time_;
  bool has_ids_ = true;
  std::optional<bool> has_layers_;                         ///< once there is a row
  std::unordered_map<std::int64_t, std::uint8_t> layers_;  ///< by id
  std::vector<Aabb> boxes_;
};

}  // namespace

void TextFormat::setPeriodic(const LineReader& lines, const Cell& cell,
                             const std::array<bool, 3>& repeats) {
  const bool is_stated = repeats[0] || repeats[1] || repeats[2];
  if (option_.empty() && is_stated) {
    addOnce(summary_.left_out, "pairs across periodic boundaries (use --periodic)");
  }
  if (option_ != kStatedPeriodicBox) return;
  PeriodicBox box;
  for (int axis = 0; axis < 3; ++axis) {
    if (!repeats[axis]) continue;
    box.min[axis] = cell.origin[axis];
    box.max[axis] = cell.origin[axis] + cell.edges[axis][axis];
    if (!box.repeats(axis)) lines.fail("--periodic: the periodic box has no extent");
    for (int other = 0; other < 3; ++other) {
      if (other != axis && (cell.edges[axis][other] != 0 || cell.edges[other][axis] != 0)) {
        lines.fail("--periodic: slanted periodic boxes are not supported");
      }
    }
  }
  if (periodic_ && *periodic_ != box) {
    lines.fail(fmt::format(
        "--periodic: the periodic box is {}, but {} in the frames before: one for all is expected",
        periodicText(box), periodicText(*periodic_)));
  }
  periodic_ = box;
  if (is_stated) addOnce(summary_.used, "periodic box " + periodicText(box));
}

std::unique_ptr<IndexedFrames> openTextFrames(const std::vector<std::filesystem::path>& files,
                                              std::unique_ptr<TextFormat> format,
                                              std::string object_type,
                                              const ReadingOptions& options,
                                              ImportSummary& summary) {
  return std::make_unique<TextFrames>(files, std::move(format), std::move(object_type), options,
                                      summary);
}

Aabb boxAround(const LineReader& lines, const std::array<double, 3>& centre,
               const std::array<double, 3>& half) {
  Aabb box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(std::abs(centre[axis]) + half[axis] <= kMaxFloat)) {
      lines.fail(fmt::format("{:g} is beyond what 32-bit floats hold", centre[axis]));
    }
    box.min[axis] = floatBelow({centre[axis], -half[axis]});
    box.max[axis] = floatAbove({centre[axis], half[axis]});
  }
  return box;
}

void readParticles(LineReader& lines, TextFrame& frame, std::int64_t count,
                   const ParticleColumns& columns, double radius, const Cell& cell) {
  frame.has_ids = columns.id.has_value();
  std::vector<std::string_view> words;
  for (std::int64_t i = 0; i < count; ++i) {
    lines.require(fmt::format("{} {} of {}", columns.what, i + 1, count));
    splitWords(lines.line(), words);
    if (words.size() < columns.count || (words.size() > columns.count && !columns.more)) {
      lines.fail(fmt::format("{} columns: {} are expected", words.size(), columns.count));
    }
    std::array<double, 3> centre = columns.is_scaled ? cell.origin : std::array<double, 3>{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = lines.realNumber(words[columns.position[axis]], "a coordinate");
      double edges = columns.is_scaled ? value : 0;
      if (const auto image = columns.images[axis]) {
        edges += static_cast<double>(lines.integer(words[*image], "an image flag"));
      }
      if (!columns.is_scaled) centre[axis] += value;
      for (std::size_t k = 0; k < 3; ++k) centre[k] += edges * cell.edges[axis][k];
    }
    const double size = radiusOf(lines, words, columns, radius);
    frame.rows.push_back({.id = columns.id ? lines.integer(words[*columns.id], "the id") : i,
                          .box = boxAround(lines, centre, {size, size, size}),
                          .line = lines.number()});
  }
}

}  // namespace broadmark::imports
