// Boxes as NumPy saves them: .npy and .npz. Several files are a sequence: the frames of each, in
// turn.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "imports/files.h"
#include "imports/npy.h"
#include "sources/source.h"

namespace broadmark::sources::numpy_boxes {
namespace {

class NumpyFrames final : public IndexedFrames {
 public:
  NumpyFrames(const std::vector<std::filesystem::path>& files, const ReadingOptions& options,
              imports::ImportSummary& summary) {
    scene_.name = imports::sequenceName(files);
    scene_.object_type = "Boxes";
    scene_.world = kEmptyBox;
    std::uint64_t frames = 0;
    for (const std::filesystem::path& file : files) {
      auto array = std::make_unique<imports::NpyBoxes>(file);
      if (arrays_.empty()) scene_.objects = array->bodies();
      if (array->bodies() != scene_.objects) {
        throw InputError(fmt::format("{}: has {} bodies, {} has {}", file.string(), array->bodies(),
                                     files.front().string(), scene_.objects));
      }
      imports::addOnce(summary.used, array->description());
      frames += array->frames();
      first_.push_back(static_cast<std::uint32_t>(frames - array->frames()));
      arrays_.push_back(std::move(array));
      constexpr std::uint64_t kMaxFrames = std::numeric_limits<std::int32_t>::max();
      if (frames > kMaxFrames) throw InputError(file.string() + ": more than 2^31 - 1 frames");
    }
    scene_.frames = static_cast<std::uint32_t>(frames - 1);
    boxes_.resize(scene_.objects);
    // The world, and whether all are valid.
    for (std::uint32_t frame = 0; frame < frames && scene_.objects > 0; ++frame) {
      options.report(static_cast<double>(frame) / static_cast<double>(frames));
      for (const Aabb& box : readBoxes(frame)) {
        if (box == kEmptyBox) scene_.all_present = false;
        scene_.world = merged(scene_.world, box);
      }
    }
    if (isEmpty(scene_.world)) scene_.world = {};
  }

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    const auto array = std::prev(std::ranges::upper_bound(first_, index));
    arrays_[static_cast<std::size_t>(array - first_.begin())]->read(index - *array, boxes_);
    return boxes_;
  }

  SceneInfo scene_;
  std::vector<std::unique_ptr<imports::NpyBoxes>> arrays_;
  std::vector<std::uint32_t> first_;  ///< number of each array's first frame
  std::vector<Aabb> boxes_;
};

bool recognises(const imports::FileStart& start) {
  return imports::isNpy(start.text) || imports::isNpz(start.text);
}

std::unique_ptr<IndexedFrames> open(const std::vector<std::filesystem::path>& files,
                                    const ReadingOptions& options,
                                    imports::ImportSummary& summary) {
  summary.format = "NumPy";
  return std::make_unique<NumpyFrames>(files, options, summary);
}

}  // namespace

SourceKind kind() {
  return {.what = "arrays of boxes (NumPy: .npy, .npz)",
          .import = FileImport{.formats = {"numpy"},
                               .extensions = {".npy", ".npz"},
                               .options = {},
                               .recognises = recognises,
                               .open = open}};
}

}  // namespace broadmark::sources::numpy_boxes
