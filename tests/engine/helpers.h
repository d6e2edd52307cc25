// Helpers of engine tests: temporary directories, messages of errors, small boxes.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <concepts>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/error.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BROADMARK_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define BROADMARK_SANITIZED 1
#endif
#endif

namespace broadmark::tests {

/// Whether sanitizers change the use of memory and time.
#ifdef BROADMARK_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// A new directory; the destructor removes it with its contents.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "broadmark-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ~TemporaryDirectory() { std::filesystem::remove_all(path_); }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }
  [[nodiscard]] bool empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

/// The message of the InputError that `action` throws; a failure and "" if there is none.
template <std::invocable Action>
std::string inputErrorOf(Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError was thrown";
  return {};
}

inline Aabb unitBox(float x, float y = 0, float z = 0) {
  return {{x, y, z, 0}, {x + 1, y + 1, z + 1, 0}};
}

inline void expectNear(const Aabb& box, const Aabb& expected, float tolerance) {
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(box.min[axis], expected.min[axis], tolerance) << "axis " << axis;
    EXPECT_NEAR(box.max[axis], expected.max[axis], tolerance) << "axis " << axis;
  }
  EXPECT_EQ(box.min[3], 0);
  EXPECT_EQ(box.max[3], 0);
}

/// `n` unit boxes along x, each of which touches its neighbours only: n - 1 pairs.
inline std::vector<Aabb> chain(std::size_t n) {
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < n; ++i) boxes.push_back(unitBox(static_cast<float>(i)));
  return boxes;
}

}  // namespace broadmark::tests
