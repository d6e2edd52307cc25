// Typed parameters: conversion from and to text, and invalid values.

#include "broadmark/parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cfloat>

#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A parameter of each type.
class TypedParameters final : public Parametrised {
 public:
  bool verbose = false;
  std::int64_t cells = 200;
  double margin = 0.01;
  double scale = 1;
  Choice shape{"cubes", {"cubes", "spheres"}};
  std::string input;

  void visitParameters(const ParameterVisitor& visit) override {
    visit({.name = "verbose", .doc = "says more", .value = &verbose});
    visit({.name = "cells", .doc = "bodies per cell", .value = &cells, .min = 1, .max = 1000});
    visit({.name = "margin", .doc = "world units", .value = &margin, .min = 0, .max = 1});
    visit({.name = "scale", .doc = "any", .value = &scale, .min = -DBL_MAX, .max = DBL_MAX});
    visit({.name = "shape", .doc = "what bodies are", .value = &shape});
    visit({.name = "input", .doc = "a path", .value = &input});
  }
};

TEST(Parameters, AllTypesAreSetFromText) {
  TypedParameters parameters;
  setParameters(parameters, {{"verbose", "on"},
                             {"cells", "1000"},
                             {"margin", "2.5e-1"},
                             {"scale", "-3"},
                             {"shape", "spheres"},
                             {"input", "a b=c"}});
  EXPECT_TRUE(parameters.verbose);
  EXPECT_EQ(parameters.cells, 1000);
  EXPECT_EQ(parameters.margin, 0.25);
  EXPECT_EQ(parameters.scale, -3);
  EXPECT_EQ(parameters.shape.value, "spheres");
  EXPECT_EQ(parameters.input, "a b=c");
}

TEST(Parameters, UnitsAreThoseThatTheExplanationEndsWith) {
  double value = 0;
  const auto unit = [&](std::string_view doc) {
    return parameterUnit({.name = "some", .doc = doc, .value = &value});
  };
  EXPECT_EQ(unit("time between frames, in seconds"), "s");
  EXPECT_EQ(unit("speed below which a body is slow, in world units per second"), "units/s");
  EXPECT_EQ(unit("size of a subproblem, in boxes, below which it is scanned"), "");
  EXPECT_EQ(unit("bodies per cell"), "");
}

TEST(Parameters, SwitchesTakeTheUsualWords) {
  for (const auto& [text, value] : std::map<std::string, bool>{{"on", true},
                                                               {"true", true},
                                                               {"1", true},
                                                               {"off", false},
                                                               {"false", false},
                                                               {"0", false}}) {
    TypedParameters parameters;
    parameters.verbose = !value;
    setParameters(parameters, {{"verbose", text}});
    EXPECT_EQ(parameters.verbose, value) << text;
  }
}

TEST(Parameters, WhatIsNotSetKeepsItsDefault) {
  TypedParameters parameters;
  setParameters(parameters, {});
  EXPECT_EQ(parameterValues(parameters), (ParameterValues{{"verbose", "off"},
                                                          {"cells", "200"},
                                                          {"margin", "0.01"},
                                                          {"scale", "1"},
                                                          {"shape", "cubes"},
                                                          {"input", ""}}));
}

TEST(Parameters, TextReadsBackAsTheSameValue) {
  for (const double value : {0.1, 1.0 / 3, -1e-300, DBL_MAX, 123456789.123456789}) {
    TypedParameters parameters;
    parameters.scale = value;
    TypedParameters copy;
    setParameters(copy, parameterValues(parameters));
    EXPECT_EQ(copy.scale, value);
  }
}

TEST(Parameters, BadValuesAreRefusedAndNamed) {
  const std::map<std::string, std::vector<std::string>> bad = {
      {"verbose", {"", "maybe", "ON", "2"}},
      {"cells", {"", "0", "1001", "-5", "1.5", "1e2", "1 ", "many", "99999999999999999999"}},
      {"margin", {"", "-0.001", "1.001", "nan", "NaN", "inf", "-inf", "1e999", "0.5m", "0,5"}},
      {"scale", {"nan", "inf", "-inf", "infinity"}},
      {"shape", {"", "cube", "Cubes", "cones"}}};
  for (const auto& [name, texts] : bad) {
    for (const std::string& text : texts) {
      TypedParameters parameters;
      const auto set = [&] { setParameters(parameters, {{name, text}}); };
      EXPECT_THAT(inputErrorOf(set), AllOf(HasSubstr(name), HasSubstr("'" + text + "'")));
      EXPECT_EQ(parameterValues(parameters), [] {
        TypedParameters untouched;
        return parameterValues(untouched);
      }());
    }
  }
}

TEST(Parameters, MessagesSayWhatWouldBeRight) {
  TypedParameters parameters;
  EXPECT_THAT(inputErrorOf([&] { setParameters(parameters, {{"cells", "0"}}); }),
              AllOf(HasSubstr("cells"), HasSubstr("'0'"), HasSubstr("1…1000")));
  EXPECT_THAT(inputErrorOf([&] { setParameters(parameters, {{"shape", "cube"}}); }),
              AllOf(HasSubstr("shape"), HasSubstr("'cube'"), HasSubstr("did you mean 'cubes'"),
                    HasSubstr("spheres")));
}

TEST(Parameters, UnknownNamesSuggestTheNearest) {
  TypedParameters parameters;
  EXPECT_THAT(inputErrorOf([&] { setParameters(parameters, {{"cell", "7"}}); }),
              AllOf(HasSubstr("'cell'"), HasSubstr("did you mean 'cells'?")));
  Parametrised nothing;
  EXPECT_THAT(inputErrorOf([&] { setParameters(nothing, {{"cells", "7"}}); }),
              AllOf(HasSubstr("unknown"), HasSubstr("'cells'"), HasSubstr("no parameters")));
}

TEST(Parameters, RangesAsText) {
  std::map<std::string, std::string> ranges;
  TypedParameters parameters;
  parameters.visitParameters(
      [&](const Parameter& p) { ranges.emplace(p.name, parameterRange(p)); });
  EXPECT_EQ(ranges["verbose"], "on|off");
  EXPECT_EQ(ranges["cells"], "1…1000");
  EXPECT_EQ(ranges["margin"], "0…1");
  EXPECT_EQ(ranges["shape"], "cubes|spheres");
  EXPECT_EQ(ranges["input"], "TEXT");
}

}  // namespace
}  // namespace broadmark::tests
