// Optional parts of a build: help and lists show the included parts, and a message names a missing
// part.

#include "parts.h"

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

using Parts = EndToEnd;

TEST_F(Parts, AreShownWhereTheyAreIncluded) {
  struct Shown {
    BuildPart part;
    Arguments call;
    std::vector<std::string> words;
  };
  const Shown all[] = {
      {parts::kRenderer, {"--help"}, {"--screenshot", "--frame ", "--size", "--gl"}},
      {parts::kRenderer, {"bake", "--help"}, {"--movie ", "--movie-every", "--size", "--gl"}},
      {parts::kInspector, {"--help"}, {"--ui", "--script", "inspector"}},
      {parts::kOpenCl, {"--help"}, {"--device", ", devices,"}},
      {parts::kOpenCl, {"list"}, {"Compute devices", "gpu-", "b3-"}},
      {parts::kCgal, {"list"}, {"cgal: "}},
      {parts::kBoost, {"list"}, {"boost-rtree: "}},
      {parts::kEmbree, {"list"}, {"embree-morton: "}},
      {parts::kFcl, {"list"}, {"fcl: "}},
      {parts::kOde, {"list"}, {" ode: ", "ode-hash: "}}};
  for (const Shown& shown : all) {
    const ProgramResult ended = run(shown.call);
    EXPECT_EQ(ended.status, 0) << ended.err;
    const std::string text = onOneLine(ended.out);
    for (const std::string& word : shown.words) {
      EXPECT_EQ(text.find(word) != std::string::npos, shown.part.included) << word;
    }
  }
}

TEST_F(Parts, AreRefusedWhereTheyAreLeftOut) {
  struct Refused {
    BuildPart part;
    Arguments call;
    std::string word;
  };
  const Arguments scene = {"--headless", "freefall", "--objects", "5", "--quiet"};
  const auto with = [&](const std::string& option, const std::string& value) {
    Arguments call = scene;
    call.insert(call.end(), {option, value});
    return call;
  };
  const Refused all[] = {
      {parts::kRenderer, with("--screenshot", "s.png"), "BROADMARK_RENDER"},
      {parts::kRenderer, {"bake", "--output", "out", "--movie", "film"}, "BROADMARK_RENDER"},
      {parts::kInspector, {"freefall"}, "BROADMARK_INSPECTOR"},
      {parts::kInspector, {"--headless", "--ui"}, "BROADMARK_INSPECTOR"},
      {parts::kOpenCl, with("--device", "0"), "BROADMARK_OPENCL"},
      {parts::kOpenCl, with("--algorithm", "gpu-grid"), "'gpu-grid'"},
      {parts::kOpenCl, {"list", "devices"}, "'devices'"},
      {parts::kCgal, with("--algorithm", "cgal"), "'cgal'"},
      {parts::kBoost, with("--algorithm", "boost-rtree"), "'boost-rtree'"},
      {parts::kEmbree, with("--algorithm", "embree-sah"), "'embree-sah'"},
      {parts::kFcl, with("--algorithm", "fcl"), "'fcl'"},
      {parts::kOde, with("--engine", "ode"), "'ode'"},
      {parts::kOde, with("--algorithm", "ode-sap"), "'ode-sap'"}};
  for (const Refused& refused : all) {
    if (!refused.part.included) expectRefusal(refused.call, {refused.word});
  }
}

}  // namespace
}  // namespace broadmark::tests
