// .posrot recordings: positions and rotations instead of boxes, byte for byte as the original
// Broadmark's. Laid out as an .aabbs recording (recording.h), but only the initial set holds boxes:
// those of the bodies before they were turned. Each further set holds poses: position x y z 0,
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

class OriginalRecordingFile;  // a recording laid out as the original's while it is written

/// How far the squared length of a recorded quaternion may be from 1.
inline constexpr float kRotationTolerance = 1e-3F;

/// Reads a .posrot recording. A frame's boxes are the tight boxes of the posed bodies. Bodies are
/// boxes as large as their initial ones; where the object type is "Spheres" they are balls, whose
/// boxes do not depend on the rotation.
///
/// The initial boxes give sizes only up to the rounding of their corners. A size within that
/// rounding of a whole number of thousandths is taken to be that number. So bodies of usual sizes
/// get exactly the boxes they had in the simulation; others differ by a few units in the last
/// place.
class PosrotReader final : public OriginalRecording, public PoseSource {
 public:
  explicit PosrotReader(const std::filesystem::path& path);
  /// The same from an open descriptor, which this takes over; `name` stands for it in messages.
  PosrotReader(FileDescriptor file, std::string name);

  std::span<const Aabb> unturnedBoxes() override { return unturned_; }
  std::span<const Pose> poses() override { return poses_; }

  // What follows is known once a frame has been read.

  /// Half the size of each body, unturned.
  [[nodiscard]] std::span<const Vec3> halfExtents() const { return half_extents_; }
  /// Half the size of a body's tight box when it is turned so.
  [[nodiscard]] Vec3 extents(std::size_t body, const Quaternion& rotation) const {
    return balls_ ? half_extents_[body] : turnedExtents(half_extents_[body], rotation);
  }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;

  void readSizes();

  bool balls_;
  std::vector<Aabb> unturned_;
  std::vector<Vec3> half_extents_;
  std::vector<Pose> poses_;
  LargeVector<Aabb> boxes_;
};

/// Writes a .posrot recording; as RecordingWriter, it leaves nothing unless finished.
class PosrotWriter {
 public:
  /// Throws InputError if the scene cannot be recorded (names, counts) or the path not be written.
  PosrotWriter(const std::filesystem::path& path, const SceneInfo& scene);
  ~PosrotWriter();

  /// Comes first: the unturned boxes. Throws InputError when one is not finite or inverted.
  void writeBoxes(std::span<const Aabb> unturned);
  /// Then, for each frame from 1 on, its poses. Throws InputError when one is not finite or a
  /// quaternion not of unit length.
  void write(std::span<const Pose> poses);
  /// Completes the recording and gives it its name. Exactly 1 + frames sets must be written.
  /// Returns the recording's hash, as Recording::hash().
  std::string finish();

 private:
  std::unique_ptr<OriginalRecordingFile> file_;
  std::vector<std::array<float, 8>> records_;  ///< poses as they lie in the file
};

}  // namespace broadmark
