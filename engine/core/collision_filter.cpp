// Layers, worlds and tags.

#include "broadmark/collision_filter.h"

#include <algorithm>
#include <stdexcept>
#include <string>

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

CollisionFilter::CollisionFilter(std::span<const BodyGroups> bodies, const LayerMatrix& matrix,
                                 bool changes) {
  const auto data = std::make_shared<Data>();
  data->bodies = bodies.size();
  data->changes = changes;
  data->matrix = matrix;
  const auto store = [&](auto BodyGroups::* member, auto default_value, auto& all) {
    const bool any = std::ranges::any_of(
        bodies, [&](const BodyGroups& body) { return body.*member != default_value; });
    if (!any) return;
    for (const BodyGroups& body : bodies) all.push_back(body.*member);
  };
  store(&BodyGroups::layer, std::uint8_t{0}, data->layers);
  store(&BodyGroups::world, 0U, data->worlds);
  store(&BodyGroups::tags, BodyGroups::kNoTags, data->tags);
  for (const BodyGroups::Tags& own : data->tags) data->tag_vectors.push_back(toVector(own));
  for (const std::uint8_t layer : data->layers) {
    if (layer >= LayerMatrix::kLayers) {
      throw std::invalid_argument("layer " + std::to_string(layer) + ": there are layers 0 to " +
                                  std::to_string(LayerMatrix::kLayers - 1));
    }
  }
  const bool has_groups = !data->layers.empty() || !data->worlds.empty() || !data->tags.empty();
  const bool is_plain = matrix.collide(0, 0) && (!changes || matrix == LayerMatrix().set(0, 0));
  if (!has_groups && is_plain) {
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
  return {groups, data_->matrix, data_->changes};
}

CollisionFilter CollisionFilter::with(std::span<const std::uint32_t> changed,
                                      std::span<const BodyGroups> groups, std::size_t count) const {
  std::vector<BodyGroups> all;
  all.reserve(count);
  for (std::uint32_t body = 0; body < count; ++body) all.push_back(groupsOf(body));
  for (std::size_t i = 0; i < changed.size(); ++i) {
    all[changed[i]].layer = groups[i].layer;
    all[changed[i]].tags = groups[i].tags;
  }
  return {all, matrix(), true};
}

CollisionFilter CollisionFilter::with(std::span<const std::uint32_t> changed,
                                      const CollisionFilter& source, std::size_t count) const {
  std::vector<BodyGroups> groups;
  groups.reserve(changed.size());
  for (const std::uint32_t body : changed) groups.push_back(source.groupsOf(body));
  return with(changed, groups, count);
}

namespace {

/// Keeps the wanted and the invalid pairs. Without branches on a pair's result, which cannot be
/// predicted.
template <class Wanted>
std::size_t retain(std::span<Pair> pairs, std::size_t bodies, const Wanted& wanted) {
  std::size_t count = 0;
  for (const Pair pair : pairs) {
    pairs[count] = pair;
    bool keep = true;
    if (pair.a < pair.b && pair.b < bodies) [[likely]]
      keep = wanted(pair);
    count += keep ? 1 : 0;
  }
  return count;
}

}  // namespace

std::size_t CollisionFilter::retainWanted(std::span<Pair> pairs) const {
  if (data_ == nullptr) return pairs.size();
  const Data& data = *data_;
  const auto differ_in_tags = [&](Pair pair) {
    return !shareTag(data.tag_vectors[pair.a], data.tag_vectors[pair.b]);
  };
  const bool layers_collide = data.matrix.collide(0, 0);  // where all are in the first
  const bool has_layers = !data.layers.empty();
  const bool has_worlds = !data.worlds.empty();
  const bool has_tags = !data.tags.empty();
  if (has_tags && !has_layers && !has_worlds && layers_collide) {  // meshes: made fast
    return retain(pairs, data.bodies, differ_in_tags);
  }
  return retain(pairs, data.bodies, [&](Pair pair) {
    bool wanted =
        has_layers ? data.matrix.collide(data.layers[pair.a], data.layers[pair.b]) : layers_collide;
    if (has_worlds) wanted &= data.worlds[pair.a] == data.worlds[pair.b];
    if (has_tags) wanted &= differ_in_tags(pair);
    return wanted;
  });
}

bool operator==(const CollisionFilter& a, const CollisionFilter& b) {
  if (a.data_ == nullptr || b.data_ == nullptr) return a.data_ == b.data_;
  if (a.data_ == b.data_) return true;
  return a.data_->matrix == b.data_->matrix && a.data_->layers == b.data_->layers &&
         a.data_->worlds == b.data_->worlds && a.data_->tags == b.data_->tags;
}

LiveFilter::LiveFilter(const CollisionFilter& first, std::size_t bodies)
    : data_(std::make_shared<CollisionFilter::Data>()) {
  data_->bodies = bodies;
  data_->matrix = first.matrix();
  data_->worlds.assign(first.worlds().begin(), first.worlds().end());
  data_->layers.resize(bodies);
  data_->tags.resize(bodies);
  data_->tag_vectors.resize(bodies);
  for (std::uint32_t body = 0; body < bodies; ++body) update(body, first);
}

CollisionFilter LiveFilter::filter() const {
  CollisionFilter filter;
  filter.data_ = data_;
  return filter;
}

void LiveFilter::update(std::uint32_t body, const CollisionFilter& source) {
  const BodyGroups groups = source.groupsOf(body);
  data_->layers[body] = groups.layer;
  data_->tags[body] = groups.tags;
  data_->tag_vectors[body] = CollisionFilter::toVector(groups.tags);
}

}  // namespace broadmark
