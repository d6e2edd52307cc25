// Changes of an authored scene. A change is an exchange: it holds values that the scene does not
// have now, and swaps them with those that it has. So undo and redo are the same operation, nothing
// is computed backwards, and the former values come back bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/scene_editor.h"

namespace broadmark::scenes {

using SharedIds = std::shared_ptr<const BodyIds>;

class SceneChange {
 public:
  virtual ~SceneChange() = default;
  /// Swaps what the scene has with what this holds.
  virtual void exchange(AuthoredScene&) = 0;
  /// The most memory that it takes, done or undone.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
  /// Whether undoing this change also undoes `later`, if only values changed between the two.
  [[nodiscard]] virtual bool covers(const SceneChange& later) const = 0;
  /// Whether it changes the ids of bodies.
  [[nodiscard]] virtual bool renumbers() const { return false; }
};

/// New values of one property of some bodies.
template <class Value>
class BodyValues final : public SceneChange {
 public:
  BodyValues(Value AuthoredBody::*property, SharedIds bodies, std::unique_ptr<Value[]> values)
      : property_(property), bodies_(std::move(bodies)), values_(std::move(values)) {}

  void exchange(AuthoredScene& scene) override {
    for (std::size_t i = 0; i < bodies_->size(); ++i) {
      std::swap(scene.bodies[(*bodies_)[i]].*property_, values_[i]);
    }
  }
  [[nodiscard]] std::size_t bytes() const override {
    return bodies_->size() * (sizeof(Value) + sizeof(std::uint32_t));
  }
  [[nodiscard]] bool covers(const SceneChange& later) const override {
    const auto* other = dynamic_cast<const BodyValues*>(&later);
    return other != nullptr && other->property_ == property_ &&
           (other->bodies_ == bodies_ || *other->bodies_ == *bodies_);
  }

 private:
  Value AuthoredBody::*property_;
  SharedIds bodies_;
  std::unique_ptr<Value[]> values_;
};

/// Bodies that are added or removed.
class BodyPresence final : public SceneChange {
 public:
  /// `ids`: of the bodies while they are in the scene. `absent`: bodies to add, in the order of
  /// their ids; empty: the bodies are in the scene and are removed.
  BodyPresence(SharedIds ids, std::vector<AuthoredBody> absent)
      : ids_(std::move(ids)), absent_(std::move(absent)) {}

  void exchange(AuthoredScene& scene) override {
    if (absent_.empty()) {
      remove(scene.bodies);
    } else {
      insert(scene.bodies);
    }
  }
  [[nodiscard]] std::size_t bytes() const override {
    return ids_->size() * (sizeof(AuthoredBody) + sizeof(std::uint32_t));
  }
  [[nodiscard]] bool covers(const SceneChange&) const override { return false; }
  [[nodiscard]] bool renumbers() const override { return true; }

 private:
  void remove(std::vector<AuthoredBody>& bodies);
  void insert(std::vector<AuthoredBody>& bodies);

  SharedIds ids_;
  std::vector<AuthoredBody> absent_;
};

/// A new value of one property of the scene.
template <class Value>
class SceneValue final : public SceneChange {
 public:
  SceneValue(Value AuthoredScene::*property, Value value)
      : property_(property), value_(std::move(value)) {}

  void exchange(AuthoredScene& scene) override { std::swap(scene.*property_, value_); }
  [[nodiscard]] std::size_t bytes() const override {
    constexpr std::size_t kUsualText = 4096;  // names and parameters hold no bodies
    return kUsualText;
  }
  [[nodiscard]] bool covers(const SceneChange& later) const override {
    const auto* other = dynamic_cast<const SceneValue*>(&later);
    return other != nullptr && other->property_ == property_;
  }

 private:
  Value AuthoredScene::*property_;
  Value value_;
};

}  // namespace broadmark::scenes
