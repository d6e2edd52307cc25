// Finds the requested recording and replays it.

#include "engines/replay.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <tuple>

#include "broadmark/error.h"
#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

namespace fs = std::filesystem;

/// A recording in a directory, as described by its file name.
struct Candidate {
  fs::path path;
  std::size_t preference = 0;  ///< index of its extension: lower is better
  std::uint32_t objects = 0;
  std::uint32_t frames = 0;
};

/// Parses a file name; nullopt unless it names a recording of this scene and object type.
std::optional<Candidate> candidateOf(const fs::path& path, const std::string& scene,
                                     const std::string& object_type,
                                     const std::vector<std::string_view>& extensions) {
  const auto extension = std::ranges::find(extensions, path.extension().string());
  if (extension == extensions.end()) return {};
  Candidate candidate{.path = path,
                      .preference = static_cast<std::size_t>(extension - extensions.begin())};
  const std::string name = path.stem().string();
  const std::string start = fmt::format("{} {} ", scene, object_type);
  int length = 0;
  if (!name.starts_with(start) ||
      std::sscanf(name.c_str() + start.size(), "N%9u F%9uframes%n", &candidate.objects,
                  &candidate.frames, &length) != 2 ||
      start.size() + static_cast<std::size_t>(length) != name.size()) {
    return {};
  }
  return candidate;
}

class ReplaySimulation final : public Simulation {
 public:
  ReplaySimulation(const SceneListing& scene, const ReplayEntry& engine,
                   std::string_view required_extension)
      : Simulation(scene),
        entry_(engine),
        required_extension_(required_extension),
        object_type_(choiceOf(objectTypes())),
        engine_{engine.listing.id, {engine.listing.id}} {}

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"objects", "number of bodies", &objects_, 0, kMaxBodies});
    visit({"frames", "number of frames after the initial pose; 0: all recorded frames", &frames_, 0,
           kMaxFrames});
    visit({"object_type", "shape of the bodies", &object_type_});
    visit({"engine", "engine that replays the recording", &engine_});
    visit({"input", "recording to replay, or a folder that contains it under its standard name",
           &input_});
  }

  [[nodiscard]] const SceneInfo& scene() const override {
    // The parameters may change until the first frame.
    if (!replay_) info_ = describe(*open());
    return info_;
  }

  [[nodiscard]] fs::path input() const override { return find(); }
  /// The hash of the open recording, even if its path now names another file.
  [[nodiscard]] std::string inputHash() override {
    return replay_ ? replay_->inputHash() : openRecordingFile(input())->hash();
  }

  Frame rewind() override {
    replay_ = open();
    info_ = describe(*replay_);
    index_ = 0;
    return replay_->rewind();
  }

  std::optional<Frame> next() override {
    if (!replay_) rewind();
    if (index_ == info_.frames) return {};
    ++index_;
    return replay_->next();
  }

  std::span<const Aabb> unrotatedBoxes() override { return replay_->unrotatedBoxes(); }
  std::span<const Pose> poses() override { return replay_->poses(); }

 private:
  [[nodiscard]] std::string objectTypeName() const {
    return entryOf(objectTypes(), object_type_.value, "object type").listing.name;
  }

  /// The required number of bodies in the recording.
  [[nodiscard]] std::int64_t recordedObjects() const {
    return objects_ / entry_.bodies_per_recorded;
  }

  [[nodiscard]] SceneInfo describe(const Replay& replay) const {
    SceneInfo info = replay.scene();
    if (frames_ > 0) info.frames = static_cast<std::uint32_t>(frames_);
    return info;
  }

  /// Opens the requested recording and checks that its contents match its name.
  [[nodiscard]] std::unique_ptr<Replay> open() const {
    const fs::path path = find();
    auto recording = openRecordingFile(path);
    const SceneInfo& info = recording->scene();
    if (info.name != listing().name || info.object_type != objectTypeName() ||
        info.objects != recordedObjects() || info.frames < frames_) {
      throw InputError(fmt::format("{}: contains {} {} N{} F{}, but {} is needed", path.string(),
                                   info.name, info.object_type, info.objects, info.frames,
                                   description()));
    }
    return entry_.create(std::move(recording));
  }

  [[nodiscard]] std::string description() const {
    return fmt::format("{} {} N{} with at least {} frames ({})", listing().name, objectTypeName(),
                       recordedObjects(), frames_, fmt::join(entry_.extensions, " or "));
  }

  /// The requested recording: the shortest sufficient one, or the longest when all frames are
  /// requested; among equals the one with the preferred extension.
  [[nodiscard]] fs::path find() const {
    const auto& extensions = entry_.extensions;
    if (required_extension_ == kBroadmarkExtension &&
        std::ranges::find(extensions, required_extension_) == extensions.end()) {
      throw InputError(fmt::format(
          "--engine {}: cannot replay {}: {} recordings hold neither absent bodies nor layers or "
          "worlds",
          engine_.value, listing().id, fmt::join(extensions, " and ")));
    }
    if (input_.empty()) {
      throw InputError(fmt::format(
          "--engine {}: name the recording to replay, or its folder, with --input", engine_.value));
    }
    const std::vector<Candidate> available = candidates();
    if (objects_ % entry_.bodies_per_recorded != 0) {
      throw InputError(
          fmt::format("--engine {} makes {} bodies of each: {} is not a multiple of {}{}",
                      engine_.value, entry_.bodies_per_recorded, objects_,
                      entry_.bodies_per_recorded, availableText(available)));
    }
    if (fs::is_regular_file(input_)) return inputFile();
    const Candidate* best = nullptr;
    for (const Candidate& candidate : available) {
      const bool suits = candidate.objects == recordedObjects() && candidate.frames >= frames_;
      if (suits && (best == nullptr || isBetter(candidate, *best))) best = &candidate;
    }
    if (best == nullptr) {
      throw InputError(
          fmt::format("{}: no recording of {}{}", input_, description(), availableText(available)));
    }
    return best->path;
  }

  /// The file named by `input`.
  [[nodiscard]] fs::path inputFile() const {
    fs::path path = input_;
    if (std::ranges::find(entry_.extensions, path.extension().string()) ==
        entry_.extensions.end()) {
      throw InputError(fmt::format("{}: --engine {} reads {}", input_, engine_.value,
                                   fmt::join(entry_.extensions, " or ")));
    }
    return path;
  }

  [[nodiscard]] bool isBetter(const Candidate& a, const Candidate& b) const {
    if (a.frames != b.frames) return frames_ == 0 ? a.frames > b.frames : a.frames < b.frames;
    return a.preference < b.preference;
  }

  /// The input directory, and its folders of baked recordings.
  [[nodiscard]] std::vector<fs::path> directories() const {
    std::vector<fs::path> all = {input_};
    for (const RecorderListing& recorder : builtinRecorders()) {
      const fs::path folder = all.front() / recorder.folder;
      if (fs::is_directory(folder)) all.push_back(folder);
    }
    return all;
  }

  /// All recordings of this scene and object type in the input directory, by size.
  [[nodiscard]] std::vector<Candidate> candidates() const {
    if (fs::is_regular_file(input_)) return {};
    std::vector<Candidate> found;
    for (const fs::path& directory : directories()) {
      std::error_code error;
      for (const auto& file : fs::directory_iterator(directory, error)) {
        const auto candidate =
            candidateOf(file.path(), listing().name, objectTypeName(), entry_.extensions);
        if (candidate) found.push_back(*candidate);
      }
      if (error) {
        throw InputError(fmt::format("{}: cannot read: {}", directory.string(), error.message()));
      }
    }
    std::ranges::sort(found, [](const Candidate& a, const Candidate& b) {
      return std::tie(a.objects, a.frames, a.path) < std::tie(b.objects, b.frames, b.path);
    });
    return found;
  }

  /// For messages: "; there are N1000 F50 (gives 8000 bodies), …".
  [[nodiscard]] std::string availableText(const std::vector<Candidate>& candidates) const {
    if (fs::is_regular_file(input_)) return {};
    if (candidates.empty()) {
      return fmt::format("; there is none of {} {}", listing().name, objectTypeName());
    }
    std::vector<std::string> names;
    for (const Candidate& candidate : candidates) {
      std::string name = fmt::format("N{} F{}", candidate.objects, candidate.frames);
      if (entry_.bodies_per_recorded > 1) {
        name += fmt::format(" (gives {} bodies)",
                            std::uint64_t{candidate.objects} * entry_.bodies_per_recorded);
      }
      // Sorted: recordings of several formats with equal counts are adjacent.
      if (names.empty() || names.back() != name) names.push_back(std::move(name));
    }
    constexpr std::size_t kMaxNames = 8;
    if (names.size() > kMaxNames) names[kMaxNames] = "…";
    names.resize(std::min(names.size(), kMaxNames + 1));
    return fmt::format("; there are {}", fmt::join(names, ", "));
  }

  ReplayEntry entry_;
  std::string_view required_extension_;
  std::int64_t objects_ = 1000;
  std::int64_t frames_ = 0;
  Choice object_type_;
  Choice engine_;
  std::string input_;
  mutable SceneInfo info_;
  std::unique_ptr<Replay> replay_;
  std::uint32_t index_ = 0;
};

}  // namespace

PoseSource& Replay::posed() const {
  if (auto* source = dynamic_cast<PoseSource*>(recording_.get())) return *source;
  throw InputError(recording_->name() + ": contains only boxes, not the poses that .posrot needs");
}

std::vector<ReplayEntry> replayEntries() {
  return {{.listing = {.id = "viewer",
                       .summary = "replays a recording (.posrot, .aabbs, .broadmark)",
                       .dynamics = Dynamics::replayed},
           .bodies_per_recorded = 1,
           .extensions = {kPosrotExtension, kAabbsExtension, kBroadmarkExtension},
           .create = makeEntry<Replay, Replay>},
          splitter::entry()};
}

std::unique_ptr<Simulation> makeReplay(const SceneListing& scene, const ReplayEntry& engine,
                                       std::string_view required_extension) {
  return std::make_unique<ReplaySimulation>(scene, engine, required_extension);
}

}  // namespace broadmark::scenes
