// Layers, worlds and tags.

#include "broadmark/collision_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace broadmark {

LayerMatrix LayerMatrix::all() {
  LayerMatrix matrix;
  matrix.rows_.fill(std::numeric_limits<std::uint32_t>::max());
  return matrix;
}

LayerMatrix& LayerMatrix::set(std::size_t a, std::size_t b, bool collide) {
  const auto set_bit = [&](std::size_t row, std::size_t column) {
    const std::uint32_t bit = std::uint32_t{1} << column;
    rows_[row] = collide ? rows_[row] | bit : rows_[row] & ~bit;
  };
  set_bit(a, b);
  set_bit(b, a);
  return *this;
}

CollisionFilter::CollisionFilter(std::span<const BodyGroups> bodies, const LayerMatrix& matrix) {
  const auto data = std::make_shared<Data>();
  data->matrix = matrix;
  const auto store = [&](auto BodyGroups::*member, auto default_value, auto& all) {
    const bool any = std::ranges::any_of(
        bodies, [&](const BodyGroups& body) { return body.*member != default_value; });
    if (!any) return;
    for (const BodyGroups& body : bodies) all.push_back(body.*member);
  };
  store(&BodyGroups::layer, std::uint8_t{0}, data->layers);
  store(&BodyGroups::world, 0U, data->worlds);
  store(&BodyGroups::tags, BodyGroups::kNoTags, data->tags);
  for (const std::uint8_t layer : data->layers) {
    if (layer >= LayerMatrix::kLayers) {
      throw std::invalid_argument(
          fmt::format("layer {}: there are layers 0 to {}", layer, LayerMatrix::kLayers - 1));
    }
  }
  if (data->layers.empty() && data->worlds.empty() && data->tags.empty() && matrix.collide(0, 0)) {
    return;
  }
  data_ = data;
}

BodyGroups CollisionFilter::groupsOf(std::uint32_t body) const {
  BodyGroups groups;
  if (!layers().empty()) groups.layer = layers()[body];
  if (!worlds().empty()) groups.world = worlds()[body];
  if (!tags().empty()) groups.tags = tags()[body];
  return groups;
}

LayerMatrix CollisionFilter::matrix() const {
  return data_ == nullptr ? LayerMatrix().set(0, 0) : data_->matrix;
}

std::span<const std::uint8_t> CollisionFilter::layers() const {
  if (data_ == nullptr) return {};
  return data_->layers;
}

std::span<const std::uint32_t> CollisionFilter::worlds() const {
  if (data_ == nullptr) return {};
  return data_->worlds;
}

std::span<const BodyGroups::Tags> CollisionFilter::tags() const {
  if (data_ == nullptr) return {};
  return data_->tags;
}

CollisionFilter CollisionFilter::of(std::span<const std::uint32_t> bodies) const {
  if (data_ == nullptr) return {};
  std::vector<BodyGroups> groups;
  for (const std::uint32_t body : bodies) groups.push_back(groupsOf(body));
  return {groups, data_->matrix};
}

bool CollisionFilter::Data::shareTag(const BodyGroups::Tags& a, const BodyGroups::Tags& b) {
  return std::ranges::any_of(a, [&](std::uint32_t tag) {
    return tag != BodyGroups::kNoTag && std::ranges::find(b, tag) != b.end();
  });
}

bool operator==(const CollisionFilter& a, const CollisionFilter& b) {
  if (a.data_ == nullptr || b.data_ == nullptr) return a.data_ == b.data_;
  return a.data_ == b.data_ || *a.data_ == *b.data_;
}

}  // namespace broadmark
