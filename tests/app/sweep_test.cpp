// Parameter sweeps.

#include "request/sweep.h"

#include <gmock/gmock.h>

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// One parameter of each kind that sweeps treat differently.
class Thing final : public Parametrised {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"cells", "a number", &cells_, 1, 1000});
    visit({"kind", "a choice", &kind_});
    visit({"path", "a text", &path_});
  }

 private:
  std::int64_t cells_ = 1;
  Choice kind_{"a", {"a", "b"}};
  std::string path_;
};

std::vector<ParameterValues> combinationsOf(const ParameterValues& texts) {
  Thing thing;
  return combinations(thing, texts);
}

TEST(SplitList, DropsEmptyParts) {
  EXPECT_THAT(splitList({"a,b", "", ",c,", "d"}), ElementsAre("a", "b", "c", "d"));
  EXPECT_THAT(splitList({",", ""}), IsEmpty());
}

TEST(ValuesIn, AreNumbersBySizeAndNamesInTheirOrder) {
  EXPECT_THAT(valuesIn("256,64,1e2,64.0"), ElementsAre("64", "1e2", "256"));
  EXPECT_THAT(valuesIn("b,a,b"), ElementsAre("b", "a"));
  EXPECT_THAT(valuesIn("10,x,9"), ElementsAre("10", "x", "9"));
  EXPECT_THAT(valuesIn(""), ElementsAre("")) << "to be complained about later";
  EXPECT_THAT(valuesIn(","), ElementsAre(","));
}

TEST(Combinations, AreAllOfThem) {
  EXPECT_THAT(combinationsOf({}), ElementsAre(ParameterValues{}));
  EXPECT_THAT(combinationsOf({{"cells", "20,10"}, {"kind", "b,a"}}),
              ElementsAre(ParameterValues{{"cells", "10"}, {"kind", "b"}},
                          ParameterValues{{"cells", "10"}, {"kind", "a"}},
                          ParameterValues{{"cells", "20"}, {"kind", "b"}},
                          ParameterValues{{"cells", "20"}, {"kind", "a"}}));
}

TEST(Combinations, LeaveTextsAndWhatIsUnknownAlone) {
  const ParameterValues texts = {{"path", "a,b.aabbs"}, {"unknown", "1,2"}};
  EXPECT_THAT(combinationsOf(texts), ElementsAre(texts));
}

TEST(SweptText, IsPartOfAName) {
  EXPECT_EQ(sweptText({}), "");
  EXPECT_EQ(sweptText({{"seed", "2"}, {"density", "0.1"}}), " density=0.1 seed=2");
}

}  // namespace
}  // namespace broadmark::tests
