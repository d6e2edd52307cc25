// The time that `columns` cannot go below with its data: each of its passes over memory with as
// little computation as possible, beside `columns` itself on the same uniform cubes.
//
//   columns_floors [BODIES [ROUNDS]]
//
//   boxes (32 bytes) --read--> entries (16) in their columns --read--> pairs (8)
//
// Appending takes the boxes' columns from the layout and nothing else from the boxes; no entry is
// written twice, sorted, or compared.

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string_view>
#include <vector>

#include "benchmarks/contest.h"
#include "benchmarks/kinds_of_boxes.h"
#include "benchmarks/stopwatch.h"
#include "broadmark/large_array.h"
#include "columns/column_bins.h"
#include "columns/layout.h"
#include "sample.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;
using columns::CellEntry;

struct Pass {
  std::string_view name;
  std::function<void()> work;
  std::vector<double> milliseconds = {};
};

/// The position of a coordinate among the columns of a cut axis.
std::uint32_t columnOf(const columns::Quantizer& quantizer, const Aabb& box) {
  const auto axis = static_cast<std::size_t>(quantizer.axis);
  const float scaled = (box.min[axis] - quantizer.origin) * quantizer.scale;
  return static_cast<std::uint32_t>(std::clamp(scaled, 0.0F, quantizer.max)) >>
         columns::Layout::kCoordBits;
}

int run(int argc, char** argv) {
  const std::size_t bodies = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
  const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 15;
  const std::vector<std::vector<Aabb>> frames = {kinds::uniform(bodies, 0, 1),
                                                 kinds::uniform(bodies, 1, 1)};
  Contest contest("uniform", frames);
  contest.add("columns", caseOf("columns"));
  contest.run(1);
  const std::uint64_t pair_count = pairCount(contest.find("columns").answer());

  const LargeVector<Aabb> boxes(frames[0].begin(), frames[0].end());
  std::vector<Aabb> sample;
  takeSample(bodies, [&](std::size_t i) -> const Aabb& { return boxes[i]; }, sample);
  constexpr double kCopyCost = 150;  // the default of `columns`
  const columns::Layout layout(sample, bodies, kCopyCost);
  const columns::Quantizer& a = layout.quantizers().cut[0];
  const columns::Quantizer& b = layout.quantizers().cut[1];
  columns::ColumnBins bins;
  LargeArray<Pair> pairs;
  pairs.resize(pair_count);
  volatile std::uint32_t result = 0;

  std::vector<Pass> passes;
  passes.push_back({"read boxes", [&] {
                      std::uint32_t sum = 0;
                      for (const Aabb& box : boxes)
                        sum += static_cast<std::uint32_t>(box.min[0] < box.max[1]);
                      result = sum;
                    }});
  passes.push_back({"read boxes, append one entry each", [&] {
                      bins.clear(layout.size());
                      for (std::uint32_t body = 0; body < bodies; ++body) {
                        const Aabb& box = boxes[body];
                        bins.append(layout.indexOf(columnOf(a, box), columnOf(b, box)),
                                    CellEntry{0, 0, 0, body});
                      }
                    }});
  passes.push_back({"read entries", [&] {
                      std::uint32_t sum = 0;
                      for (std::size_t column = 0; column < layout.size(); ++column) {
                        bins.forEach(column, [&](const CellEntry& entry) { sum += entry.key; });
                      }
                      result = sum;
                    }});
  passes.push_back({"write pairs", [&] {
                      for (std::uint32_t i = 0; i < pair_count; ++i) pairs.data()[i] = {i, i + 1};
                      result = pairs.data()[pair_count / 2].a;
                    }});

  for (int round = 0; round < rounds; ++round) {
    contest.run(1);
    for (Pass& pass : passes) pass.milliseconds.push_back(nanosecondsOf(pass.work) * 1e-6);
  }
  double floor = 0;
  for (const Pass& pass : passes) {
    const double median = quantile(pass.milliseconds, 0.5);
    fmt::print("{:36} {:8.3f} ms\n", pass.name, median);
    if (&pass != &passes.front()) floor += median;  // appending reads the boxes, too
  }
  fmt::print("{:36} {:8.3f} ms\n", "the last three", floor);
  fmt::print("{:36} {:8.3f} ms, {} bodies, {} pairs, {} columns\n", "columns",
             contest.find("columns").median(), bodies, pair_count, layout.size());
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  return broadmark::benchmarks::runMain("columns_floors", run, argc, argv);
}
