#include "imports/mesh_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "broadmark/error.h"
#include "broadmark/scenes/simulation.h"
#include "imports/mesh_format.h"

namespace broadmark::imports {
namespace {

namespace fs = std::filesystem;

/// Adds notes that are not yet in a list; of many different ones only the first are kept.
void addNotes(std::vector<std::string>& list, const std::vector<std::string>& notes) {
  constexpr std::size_t kMaxNotes = 12;
  for (const std::string& note : notes) {
    const bool is_new = std::ranges::find(list, note) == list.end();
    if (is_new && list.size() < kMaxNotes) list.push_back(note);
    if (is_new && list.size() == kMaxNotes) list.back() = "more in other files";
  }
}

template <class Item>
bool startsWith(const std::vector<Item>& all, const std::vector<Item>& first) {
  return std::ranges::mismatch(first, all).in1 == first.end();
}

/// Whether a mesh is a known one with vertices, triangles or lines behind its own.
bool extends(const MeshTopology& mesh, const MeshTopology& known) {
  return !mesh.joined_by_position && !known.joined_by_position && mesh.vertices >= known.vertices &&
         startsWith(mesh.triangles, known.triangles) && startsWith(mesh.lines, known.lines);
}

MeshTopology readMesh(const fs::path& file, const ReadingOptions& options, const PointSink& sink,
                      ImportSummary& summary) {
  const std::string format = meshFormat(file, options.format.value);
  if (format == "gltf") return readGltf(file, options, sink, summary);
  if (!options.animation.empty()) {
    throw InputError(fmt::format(
        "{}: --animation: only glTF files name animations: omit the option", file.string()));
  }
  if (format == "obj") return readObj(file, sink, summary);
  if (format == "ply") return readPly(file, sink, summary);
  if (format == "stl") return readStl(file, sink, summary);
  throw InputError(
      fmt::format("{}: not a mesh file: PLY, OBJ, STL or glTF is expected", file.string()));
}

}  // namespace

MeshSequence::MeshSequence(const std::vector<fs::path>& files, const ReadingOptions& options,
                           ImportSummary& summary)
    : vertex_file_(unnamedFile()) {
  for (std::size_t file = 0; file < files.size(); ++file) {
    options.report(static_cast<double>(file) / static_cast<double>(files.size()));
    readFile(files[file], options, summary);
  }
}

void MeshSequence::readFile(const fs::path& file, const ReadingOptions& options,
                            ImportSummary& summary) {
  const std::size_t before = frames_.size();
  const PointSink sink = [&](std::span<const Point> points) { addFrame(points, file); };
  ImportSummary of_file;
  MeshTopology mesh = readMesh(file, options, sink, of_file);
  if (summary.format.find(of_file.format) == std::string::npos) {
    summary.format += (summary.format.empty() ? "" : "; ") + of_file.format;
  }
  if (!of_file.units.empty()) summary.units = of_file.units;
  addNotes(summary.warnings, of_file.warnings);
  addNotes(summary.used, of_file.used);
  addNotes(summary.left_out, of_file.left_out);
  const std::size_t index = addMesh(std::move(mesh), file);
  last_mesh_ = index;
  for (std::size_t frame = before; frame < frames_.size(); ++frame) {
    frames_[frame].mesh = index;
    meshes_[index].frames.push_back(static_cast<std::uint32_t>(frame));
  }
}

void MeshSequence::addFrame(std::span<const Point> points, const fs::path& file) {
  const auto invalid = std::ranges::find_if(points, [](const Point& point) {
    return !std::ranges::all_of(point, [](float value) { return std::isfinite(value); });
  });
  if (invalid != points.end()) {
    throw InputError(fmt::format("{}: vertex {} has a coordinate that is not a finite 32-bit float",
                                 file.string(), invalid - points.begin()));
  }
  if (frames_.size() > kMaxFrames) throw InputError(fmt::format("more than {} frames", kMaxFrames));
  frames_.push_back({.offset = vertex_bytes_});
  writeAll(vertex_file_.get(), std::as_bytes(points), "the vertices of a mesh");
  vertex_bytes_ += points.size_bytes();
  for (const Point& p : points) {
    const Aabb box = {{p[0], p[1], p[2], 0}, {p[0], p[1], p[2], 0}};
    world_ = merged(world_, box);
  }
}

std::size_t MeshSequence::addMesh(MeshTopology mesh, const fs::path& file) {
  const auto known = std::ranges::find(meshes_, mesh, &SequenceMesh::topology);
  if (known != meshes_.end()) return static_cast<std::size_t>(known - meshes_.begin());
  SequenceMesh added{.topology = std::move(mesh), .file = file};
  if (!meshes_.empty() && extends(added.topology, meshes_[last_mesh_].topology)) {
    added.extends = last_mesh_;
  }
  meshes_.push_back(std::move(added));
  return meshes_.size() - 1;
}

void MeshSequence::forgetFaces() {
  for (SequenceMesh& mesh : meshes_) {
    mesh.topology.triangles = {};
    mesh.topology.lines = {};
  }
}

void MeshSequence::readPoints(std::uint32_t frame, std::vector<Point>& points) const {
  const auto& [mesh, offset] = frames_[frame];
  points.resize(meshes_[mesh].topology.vertices);
  const auto bytes = std::as_writable_bytes(std::span(points));
  if (readAll(vertex_file_.get(), bytes, offset) < bytes.size()) {
    throw InputError(fmt::format("cannot read the vertices of frame {}", frame));
  }
}

}  // namespace broadmark::imports
