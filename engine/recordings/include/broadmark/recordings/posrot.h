// .posrot recordings: positions and rotations instead of boxes, compatible with the original
// Broadmark. The layout is that of an .aabbs recording (recording.h), but only the initial set
// contains boxes, of the unrotated bodies. Each further set contains poses: position x y z 0,
// quaternion x y z w.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadmark/large_array.h"
#include "broadmark/pose.h"
#include "broadmark/recordings/recording.h"

namespace broadmark {

class OriginalRecordingFile;  // an original-format recording being written

/// Tolerance for the squared length of a recorded quaternion around 1.
inline constexpr float kRotationTolerance = 1e-3F;

/// Reads a .posrot recording. A frame's boxes are the tight boxes of the posed bodies. The bodies
/// are boxes of the initial size; for the object type "Spheres" they are spheres, with boxes
/// independent of the rotation.
///
/// The initial boxes determine sizes only up to the rounding of their corners. A size within that
/// rounding of a whole number of thousandths is set to that number. So bodies of common sizes get
/// exactly the boxes of the simulation; others differ by a few units in the last place.
class PosrotReader final : public OriginalRecording, public PoseSource {
 public:
  explicit PosrotReader(const std::filesystem::path& path);
  /// Reads from an open descriptor, and takes ownership of it; `name` is used in messages.
  PosrotReader(FileDescriptor file, std::string name);

  std::span<const Aabb> unrotatedBoxes() override { return unrotated_; }
  std::span<const Pose> poses() override { return poses_; }

  // Valid once the first frame has been read.

  /// Half the size of each body, unrotated.
  [[nodiscard]] std::span<const Vec3> halfExtents() const { return half_extents_; }
  /// Half the size of a body's tight box with this rotation.
  [[nodiscard]] Vec3 extents(std::size_t body, const Quaternion& rotation) const {
    return are_spheres_ ? half_extents_[body] : rotatedExtents(half_extents_[body], rotation);
  }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;

  void readSizes();

  bool are_spheres_;
  std::vector<Aabb> unrotated_;
  std::vector<Vec3> half_extents_;
  std::vector<Pose> poses_;
  LargeVector<Aabb> boxes_;
};

/// Writes a .posrot recording. Like RecordingWriter, leaves no file unless finished.
class PosrotWriter {
 public:
  /// Throws InputError for an invalid scene (names, counts) or if the path cannot be written.
  PosrotWriter(const std::filesystem::path& path, const SceneInfo& scene);
  ~PosrotWriter();

  /// Writes the unrotated boxes; must be called first. Throws InputError if one is not finite or
  /// inverted.
  void writeBoxes(std::span<const Aabb> unrotated);
  /// Writes a frame; must be called for each one from 1 on. Throws InputError if a pose is not
  /// finite or a quaternion is not of unit length.
  void write(std::span<const Pose> poses);
  /// Completes the recording and renames it to its path. Requires exactly 1 + frames written sets.
  /// Returns the recording's hash, as Recording::hash().
  std::string finish();

 private:
  std::unique_ptr<OriginalRecordingFile> file_;
  std::vector<std::array<float, 8>> records_;  ///< poses in file layout
};

}  // namespace broadmark
