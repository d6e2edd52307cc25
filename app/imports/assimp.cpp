// Reads meshes with assimp, in a child process with limited memory and time, as damaged files may
// crash it. The child writes its result into an unnamed file: counts, triangles, then the vertices
// of each frame.
//
// Each frame of an animation poses the nodes of the scene, which place meshes, or bones that deform
// them. Assimp must not join or reorder vertices: they keep the numbers of the file.

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <optional>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/json_fields.h"
#include "broadmark/scenes/simulation.h"
#include "imports/mesh.h"

namespace broadmark::imports {
namespace {

namespace fs = std::filesystem;

/// Header of the child's output.
struct Header {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t frames = 0;
};

// ---- Child process.

/// The two keys around a time, and the interpolation factor.
template <class Key>
struct KeyInterval {
  const Key* first;
  const Key* second;
  float factor;
};
template <class Key>
KeyInterval<Key> keyIntervalAt(const Key* keys, unsigned count, double time) {
  unsigned next = 0;
  while (next < count && keys[next].mTime <= time) ++next;
  if (next == 0) return {&keys[0], &keys[0], 0};
  if (next == count) return {&keys[count - 1], &keys[count - 1], 0};
  const double from = keys[next - 1].mTime;
  const double to = keys[next].mTime;
  return {&keys[next - 1], &keys[next], static_cast<float>((time - from) / (to - from))};
}

aiVector3D valueAt(const aiVectorKey* keys, unsigned count, double time, aiVector3D fallback) {
  if (count == 0) return fallback;
  const auto [first, second, factor] = keyIntervalAt(keys, count, time);
  return first->mValue + (second->mValue - first->mValue) * factor;
}

aiMatrix4x4 matrixAt(const aiNodeAnim& channel, double time) {
  const aiVector3D scale =
      valueAt(channel.mScalingKeys, channel.mNumScalingKeys, time, aiVector3D(1, 1, 1));
  const aiVector3D position =
      valueAt(channel.mPositionKeys, channel.mNumPositionKeys, time, aiVector3D());
  aiQuaternion rotation;
  if (channel.mNumRotationKeys > 0) {
    const auto [first, second, factor] =
        keyIntervalAt(channel.mRotationKeys, channel.mNumRotationKeys, time);
    aiQuaternion::Interpolate(rotation, first->mValue, second->mValue, factor);
  }
  return {scale, rotation, position};
}

/// A scene read by assimp, posed by its first animation.
class AnimatedScene {
 public:
  explicit AnimatedScene(const aiScene& scene) : scene_(scene) {
    if (scene.mRootNode == nullptr) throw InputError("holds no scene");
    if (scene.mNumAnimations > 0) animation_ = scene.mAnimations[0];
    if (animation_ != nullptr && animation_->mNumMorphMeshChannels > 0) {
      throw InputError("its animation morphs the mesh, which is not supported");
    }
    for (unsigned i = 0; animation_ != nullptr && i < animation_->mNumChannels; ++i) {
      const aiNodeAnim* channel = animation_->mChannels[i];
      channels_[channel->mNodeName.C_Str()] = channel;
    }
    pose(0);
    visit(*scene.mRootNode, [&](const aiMesh& mesh, const aiNode&) { addTopology(mesh); });
  }

  [[nodiscard]] const MeshTopology& topology() const { return topology_; }

  /// Number of frames at `rate` frames per second.
  [[nodiscard]] std::uint64_t frames(double rate) const {
    if (animation_ == nullptr) return 1;
    const double frames = animation_->mDuration / ticksPerSecond() * rate;
    if (!(frames >= 0 && frames < kMaxFrames)) {
      throw InputError(
          fmt::format("its animation has {:g} frames: at most {} are read", frames, kMaxFrames));
    }
    constexpr double kTolerance = 1e-6;  // durations are rounded
    return static_cast<std::uint64_t>(frames + kTolerance) + 1;
  }

  /// Vertices at a time.
  const std::vector<Point>& points(double seconds) {
    pose(seconds * ticksPerSecond());
    points_.clear();
    visit(*scene_.mRootNode,
          [&](const aiMesh& mesh, const aiNode& node) { addPoints(mesh, node); });
    return points_;
  }

 private:
  [[nodiscard]] double ticksPerSecond() const {
    constexpr double kDefault = 25;  // assimp's default for files that do not state it
    return animation_ != nullptr && animation_->mTicksPerSecond > 0 ? animation_->mTicksPerSecond
                                                                    : kDefault;
  }

  /// Calls act(mesh, node) for the meshes of the node and its descendants.
  template <class Act>
  void visit(const aiNode& node, Act&& act) const {
    for (unsigned i = 0; i < node.mNumMeshes; ++i) act(*scene_.mMeshes[node.mMeshes[i]], node);
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], act);
  }

  void addTopology(const aiMesh& mesh) {
    constexpr std::uint64_t kMax = std::numeric_limits<std::int32_t>::max();
    const std::uint32_t first = topology_.vertices;
    if (first + std::uint64_t{mesh.mNumVertices} > kMax) throw InputError("has too many vertices");
    topology_.vertices += mesh.mNumVertices;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;  // a point or a line
      topology_.triangles.push_back(
          {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }

  void pose(double ticks) {
    matrices_.clear();
    poseSubtree(*scene_.mRootNode, aiMatrix4x4(), ticks);
  }
  void poseSubtree(const aiNode& node, const aiMatrix4x4& parent, double ticks) {
    const auto channel = channels_.find(node.mName.C_Str());
    const aiMatrix4x4 local =
        channel == channels_.end() ? node.mTransformation : matrixAt(*channel->second, ticks);
    const aiMatrix4x4& global = matrices_[&node] = parent * local;
    matrices_by_name_[node.mName.C_Str()] = &global;
    for (unsigned i = 0; i < node.mNumChildren; ++i) poseSubtree(*node.mChildren[i], global, ticks);
  }

  void addPoints(const aiMesh& mesh, const aiNode& node) {
    const std::vector<aiMatrix4x4> transforms = vertexTransforms(mesh, matrices_.at(&node));
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D p = transforms[transforms.size() == 1 ? 0 : i] * mesh.mVertices[i];
      points_.push_back({p.x, p.y, p.z});
    }
  }

  /// The transform of every vertex; a single transform for a mesh without bones.
  [[nodiscard]] std::vector<aiMatrix4x4> vertexTransforms(const aiMesh& mesh,
                                                          const aiMatrix4x4& node) const {
    if (mesh.mNumBones == 0) return {node};
    std::vector<aiMatrix4x4> transforms(mesh.mNumVertices, aiMatrix4x4() * 0.0F);
    std::vector<bool> is_skinned(mesh.mNumVertices);
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const auto node_matrix = matrices_by_name_.find(bone.mName.C_Str());
      if (node_matrix == matrices_by_name_.end()) throw InputError("has a bone that is not a node");
      const aiMatrix4x4 bone_matrix = *node_matrix->second * bone.mOffsetMatrix;
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        const aiVertexWeight& weight = bone.mWeights[w];
        if (weight.mVertexId >= mesh.mNumVertices)
          throw InputError("has a bone with a vertex that does not exist");
        aiMatrix4x4& transform = transforms[weight.mVertexId];
        transform = transform + bone_matrix * weight.mWeight;
        is_skinned[weight.mVertexId] = true;
      }
    }
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      if (!is_skinned[i]) transforms[i] = node;
    }
    return transforms;
  }

  const aiScene& scene_;
  const aiAnimation* animation_ = nullptr;
  std::map<std::string, const aiNodeAnim*> channels_;
  std::map<const aiNode*, aiMatrix4x4> matrices_;  ///< from the node's space into the scene's
  std::map<std::string, const aiMatrix4x4*> matrices_by_name_;
  MeshTopology topology_;
  std::vector<Point> points_;
};

/// Throws InputError for indices out of range, which assimp does not check in damaged files.
void requireIndices(const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      for (unsigned i = 0; i < face.mNumIndices; ++i) {
        if (face.mIndices[i] < mesh.mNumVertices) continue;
        throw InputError(fmt::format("face {} names vertex {}, of {}: damaged, or cut short?", f,
                                     face.mIndices[i], mesh.mNumVertices));
      }
    }
  }
}

void writeScene(const fs::path& file, double frame_rate, int out) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (scene == nullptr) {
    throw InputError(fmt::format("cannot be read: {}", importer.GetErrorString()));
  }
  requireIndices(*scene);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr) throw InputError("its polygons cannot be cut into triangles");
  AnimatedScene animated(*scene);
  const MeshTopology& topology = animated.topology();
  const auto write = [&](auto span) { writeAll(out, std::as_bytes(span), "a temporary file"); };
  const Header header{topology.vertices, topology.triangles.size(), animated.frames(frame_rate)};
  write(std::span(&header, 1));
  write(std::span(topology.triangles));
  for (std::uint64_t frame = 0; frame < header.frames; ++frame) {
    write(std::span(animated.points(static_cast<double>(frame) / frame_rate)));
  }
}

/// Limits the memory and time that this process may use in addition to its current use.
void limitResources(std::uint64_t file_bytes) {
  constexpr std::uint64_t kGib = 1ULL << 30;
  constexpr std::uint64_t kMemoryPerByte = 200;
  // Assimp reads tens of millions of bytes per second, but a damaged file may make it loop forever.
  constexpr rlim_t kMinSeconds = 10;
  constexpr std::uint64_t kBytesPerSecond = 100'000;
  std::uint64_t pages = 0;  // of the data segment: the sixth number
  std::ifstream statm("/proc/self/statm");
  for (int i = 0; i < 6; ++i) statm >> pages;
  const rlim_t bytes = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + 4 * kGib +
                       kMemoryPerByte * file_bytes;
  const rlimit memory{bytes, bytes};
  const rlim_t seconds = kMinSeconds + file_bytes / kBytesPerSecond;
  const rlimit time{seconds, seconds};
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_DATA, &memory);
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_CORE, &no_core);
}

/// Replaces the output with an error message.
void writeError(int out, std::string_view text) {
  const bool empty = ::ftruncate(out, 0) == 0 && ::lseek(out, 0, SEEK_SET) == 0;
  if (empty) writeAll(out, std::as_bytes(std::span(text)), "a temporary file");
}

[[noreturn]] void runChild(const fs::path& file, double frame_rate, int out) {
  // The signal handlers of this program would report a crash of its own.
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) ::signal(signal, SIG_DFL);
  try {
    limitResources(fs::file_size(file));
    writeScene(file, frame_rate, out);
    ::_exit(0);
  } catch (const std::bad_alloc&) {
    writeError(out, "takes too much memory to read");
  } catch (const std::exception& error) {
    writeError(out, error.what());
  }
  ::_exit(1);
}

// ---- Parent process.

/// Waits for the child. Returns its error message, or nothing on success.
std::optional<std::string> waitForChild(pid_t child, int out) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) {
    const bool timed_out = WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGXCPU;
    if (timed_out) return "assimp takes too long to read it: a damaged file?";
    const char* name = ::sigabbrev_np(WTERMSIG(status));
    return fmt::format("assimp crashed on it (SIG{}): a damaged file?",
                       name == nullptr ? "?" : name);
  }
  if (WEXITSTATUS(status) == 0) return {};
  std::string text(1 << 10, '\0');
  const ssize_t size = ::pread(out, text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  return onOneLine(text);
}

}  // namespace

MeshTopology readWithAssimp(const fs::path& file, double frame_rate, const PointSink& sink,
                            ImportSummary& summary) {
  summary.format = file.extension().string();
  openForReading(file);  // throws for a missing file
  const FileDescriptor out = unnamedFile();
  const pid_t child = ::fork();
  if (child < 0) throw InputError(fmt::format("{}: {}", file.string(), std::strerror(errno)));
  if (child == 0) runChild(file, frame_rate, out.get());
  if (const auto error = waitForChild(child, out.get())) {
    throw InputError(fmt::format("{}: {}", file.string(), *error));
  }
  std::uint64_t offset = 0;
  const auto read = [&](auto items) {
    const std::span<std::byte> bytes = std::as_writable_bytes(items);
    if (readAll(out.get(), bytes, offset) < bytes.size()) {
      throw InputError("cannot read the output of the process that runs assimp");
    }
    offset += bytes.size();
  };
  Header header;
  read(std::span(&header, 1));
  if (header.vertices == 0) throw InputError(fmt::format("{}: no vertices", file.string()));
  MeshTopology topology{.vertices = static_cast<std::uint32_t>(header.vertices)};
  topology.triangles.resize(header.triangles);
  read(std::span(topology.triangles));
  std::vector<Point> points(header.vertices);
  for (std::uint64_t frame = 0; frame < header.frames; ++frame) {
    read(std::span(points));
    sink(points);
  }
  return topology;
}

}  // namespace broadmark::imports
