// The algorithms and cases that selectors match.

#include "request/cases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "broadmark/algorithms.h"
#include "engine/helpers.h"
#include "original/ids.h"
#include "parts.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::SizeIs;
using Names = std::vector<std::string>;

Names idsOf(const Names& selectors) {
  return algorithmIds(selectAlgorithms(selectors, builtinAlgorithms(), "--algorithm"));
}

std::vector<Case> casesOf(const CaseOptions& options, const ParameterValues& parameters = {}) {
  return selectCases(options, parameters, builtinAlgorithms());
}

Names namesOf(const std::vector<Case>& cases) {
  Names names;
  for (const Case& test_case : cases) names.push_back(caseName(test_case));
  return names;
}

TEST(SelectAlgorithms, ByIdFamilyOrPattern) {
  EXPECT_THAT(idsOf({"sap"}), ElementsAre("sap")) << "the id, not the family of the same name";
  EXPECT_THAT(idsOf({"sap*"}), IsSupersetOf({"sap", "sap-simd", "sap-mt", "sap-simd-mt"}));
  EXPECT_THAT(idsOf({"Self-Check"}), ElementsAre("none", "time-validator"));
  EXPECT_THAT(idsOf({"grid bf"}), IsSupersetOf({"grid-bf", "grid2d-bf-mt"}));
  EXPECT_THAT(idsOf({"b?"}), ElementsAre("bf"));
  EXPECT_THAT(idsOf({}), testing::IsEmpty());
}

TEST(SelectAlgorithms, EachOnceInTheOrderOfTheSelectors) {
  EXPECT_THAT(idsOf({"tracy", "bf", "b?", "tracy"}), ElementsAre("tracy", "bf"));
}

TEST(SelectAlgorithms, AllAreThoseThatFindPairs) {
  const Names all = idsOf({"all"});
  for (const Algorithm& algorithm : builtinAlgorithms()) {
    EXPECT_EQ(std::ranges::count(all, algorithm.id), algorithm.traits.finds_pairs ? 1 : 0)
        << algorithm.id;
  }
}

TEST(SelectAlgorithms, UnknownOnesAreSuggested) {
  EXPECT_THAT(inputErrorOf([] { idsOf({"bf", "sapp"}); }),
              AllOf(HasSubstr("--algorithm"), HasSubstr("'sapp'"), HasSubstr("'sap'")));
  EXPECT_THAT(inputErrorOf([] { idsOf({"nothing*"}); }), HasSubstr("'nothing*'"));
}

TEST(SelectCases, WithoutSelectorsAreAll) {
  EXPECT_EQ(namesOf(casesOf({})), namesOf(casesOf({.algorithms = {"all"}})));
}

TEST(SelectCases, VaryWhatAnAlgorithmHeeds) {
  const CaseOptions options{.algorithms = {"sap", "sap-simd", "sap-mt", "sap-simd-mt"},
                            .threads = {1, 3},
                            .isas = {Isa::scalar, Isa::sse2}};
  const std::vector<Case> cases = casesOf(options);
  ASSERT_THAT(cases, SizeIs(1 + 2 + 2 + 4));
  for (const Case& test_case : cases) {
    if (!test_case.algorithm.traits.parallel) {
      EXPECT_EQ(test_case.threads, 1);
    }
    if (!test_case.algorithm.traits.vectorised) {
      EXPECT_EQ(test_case.isa, Isa::scalar);
    }
  }
  const Names names = namesOf(cases);
  EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
}

TEST(SelectCases, RepeatedChoicesMakeOneCase) {
  EXPECT_THAT(casesOf({.algorithms = {"sap-mt", "sap-mt"}, .threads = {2, 2}}), SizeIs(1));
  EXPECT_THAT(casesOf({.algorithms = {"SAP", "sap"}}), SizeIs(1)) << "the original's name, too";
}

TEST(SelectCases, TakeTheParametersThatTheyHave) {
  const auto cases = casesOf({.algorithms = {"kd", "sap"}, .threads = {1}, .isas = {Isa::scalar}},
                             {{"objects_per_leaf", "7"}, {"density", "0.5"}});
  ASSERT_THAT(cases, SizeIs(2));
  for (const Case& test_case : cases) {
    const ParameterValues expected = test_case.algorithm.id == "kd"
                                         ? ParameterValues{{"objects_per_leaf", "7"}}
                                         : ParameterValues{};
    EXPECT_EQ(test_case.parameters, expected);
  }
}

TEST(SelectCases, OneForEachValueOfAParameter) {
  const CaseOptions kd{.algorithms = {"kd"}, .isas = {Isa::scalar}};
  EXPECT_THAT(namesOf(casesOf(kd, {{"objects_per_leaf", "128,9,64,9.0"}})),
              ElementsAre("kd/scalar/objects_per_leaf=9", "kd/scalar/objects_per_leaf=64",
                          "kd/scalar/objects_per_leaf=128"))
      << "by size, each once";
  EXPECT_THAT(
      namesOf(casesOf(kd, {{"objects_per_leaf", "9,64"}, {"margin", "0,0.1"}})),
      ElementsAre("kd/scalar/margin=0/objects_per_leaf=9", "kd/scalar/margin=0/objects_per_leaf=64",
                  "kd/scalar/margin=0.1/objects_per_leaf=9",
                  "kd/scalar/margin=0.1/objects_per_leaf=64"));
}

TEST(SelectCases, AParameterMayBeOfOneAlgorithmOnly) {
  const CaseOptions options{
      .algorithms = {"dbvt-d", "kd", "kd-mt"}, .threads = {1}, .isas = {Isa::scalar}};
  const auto names = [&](const ParameterValues& given) { return namesOf(casesOf(options, given)); };
  EXPECT_THAT(names({{"kd:margin", "0.5"}}),
              ElementsAre("dbvt-d", "kd/scalar/margin=0.5", "kd-mt/scalar/t1"));
  EXPECT_THAT(
      names({{"margin", "0.3"}, {"kd*:margin", "0.5"}}),
      ElementsAre("dbvt-d/margin=0.3", "kd/scalar/margin=0.5", "kd-mt/scalar/t1/margin=0.5"))
      << "it wins over the one that is given for all";
  EXPECT_THAT(
      names({{"DBVT:margin", "0.1,0.2"}}),
      ElementsAre("dbvt-d/margin=0.1", "dbvt-d/margin=0.2", "kd/scalar", "kd-mt/scalar/t1"));
  EXPECT_THAT(
      inputErrorOf([&] { names({{"kd:margin", "1"}, {"kd*:margin", "2"}}); }),
      AllOf(HasSubstr("'kd:margin'"), HasSubstr("'kd*:margin'"), HasSubstr("margin of kd")));
}

TEST(SelectCases, TheOriginalsIdsStateTheirInstructionSet) {
  const auto cases = casesOf(
      {.algorithms = {"BF_SSE", "SAP_AVX_Parallel", "SAP"}, .threads = {2}, .isas = {Isa::scalar}});
  EXPECT_THAT(namesOf(cases), ElementsAre("bf-simd/sse2", "sap-simd-mt/avx2/t2", "sap"));
}

TEST(RequireKnownParameters, NamesTheUnknownOne) {
  requireKnownParameters({{"seed", "1"}}, {"density", "seed"});
  EXPECT_THAT(inputErrorOf([] { requireKnownParameters({{"densty", "1"}}, {"density", "seed"}); }),
              AllOf(HasSubstr("--param"), HasSubstr("'densty'"), HasSubstr("'density'")));
}

/// Whether this build excludes the algorithms with this id.
bool isLeftOut(std::string_view id) {
  return (id == "cgal" && !parts::kCgal.included) ||
         (id.starts_with("b3-") && !parts::kOpenCl.included);
}

TEST(OriginalIds, AreOfExistingAlgorithms) {
  std::set<std::string_view> names;
  for (const OriginalId& original : originalIds()) {
    SCOPED_TRACE(original.name);
    EXPECT_TRUE(names.insert(original.name).second) << "twice";
    EXPECT_EQ(findOriginalId(original.name), &original);
    const std::vector<Algorithm> known = builtinAlgorithms();
    const Algorithm* algorithm = findAlgorithm(std::string(original.algorithm), known);
    if (isLeftOut(original.algorithm)) continue;
    ASSERT_NE(algorithm, nullptr) << original.algorithm;
    if (original.isa) {
      EXPECT_TRUE(algorithm->traits.vectorised);
    }
    EXPECT_EQ(original.name.ends_with("_Parallel"),
              algorithm->traits.parallel && !algorithm->traits.on_device);
  }
  EXPECT_EQ(findOriginalId("bf"), nullptr);
}

TEST(CaseNamed, IsTheInverseOfCaseName) {
  for (const char* name : {"sap", "kd-mt/avx2/t3", "kd-mt/avx2/t3/margin=0.5/objects_per_leaf=20",
                           "sap/events", "kd-mt/avx2/t3/events/margin=0.5",
                           "dbvt-d/rays:100/margin=0.5", "time-validator/phase_us=7"}) {
    EXPECT_EQ(caseName(caseNamed(name, "")), name);
  }
  EXPECT_EQ(caseNamed("kd/scalar", "").isa, Isa::scalar);
  EXPECT_EQ(caseNamed("kd", "").isa, bestIsa());
  EXPECT_EQ(caseNamed("sap", "0").device, "0");
  EXPECT_EQ(caseNamed("sap", "", AnswerKind::events).answer, AnswerKind::events);
  EXPECT_EQ(caseNamed("sap/pairs", "", AnswerKind::events).answer, AnswerKind::pairs);
}

TEST(CaseNamed, RefusesWhatTheAlgorithmDoesNotHeed) {
  const auto refusalOf = [](const std::string& name) {
    return inputErrorOf([&] { caseNamed(name, ""); });
  };
  EXPECT_THAT(refusalOf("sap/avx2"), AllOf(HasSubstr("'avx2'"), HasSubstr("KEY=VALUE")));
  EXPECT_THAT(refusalOf("kd/t2"), AllOf(HasSubstr("'t2'"), HasSubstr("instruction set")));
  EXPECT_THAT(refusalOf("kd-mt/two"), AllOf(HasSubstr("'two'"), HasSubstr("t4")));
  EXPECT_THAT(refusalOf("kd/margin=x"), HasSubstr("margin"));
  EXPECT_THAT(refusalOf(""), HasSubstr("algorithm"));
}

}  // namespace
}  // namespace broadmark::tests
