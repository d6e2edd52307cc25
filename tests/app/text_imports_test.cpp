// Text files of other programs as these write them: columns by their names, byte order marks, line
// ends, compression, locales.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <clocale>
#include <locale>

#include "app/import_files.h"
#include "support/line_reader.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// The box of a ball with the radius 0.5.
Aabb ballAt(float x, float y, float z) {
  return boxOf({x - .5F, y - .5F, z - .5F}, {x + .5F, y + .5F, z + .5F});
}

class TextImports : public Imports {
 protected:
  /// A file with this text, compressed.
  [[nodiscard]] std::filesystem::path compress(const std::string& name,
                                               const std::string& text) const {
    std::filesystem::path path = directory_ / name;
    const gzFile file = ::gzopen(path.c_str(), "wb");
    ::gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    ::gzclose(file);
    return path;
  }
  [[nodiscard]] Source source(const std::string& name, const std::string& text,
                              const ParameterValues& options = {}) const {
    ReadingOptions reading;
    setParameters(reading, options);
    return fileSource({write(name, text).string()}, reading);
  }
  /// Boxes of frame 0 of a CSV file.
  [[nodiscard]] std::vector<Aabb> csv(const std::string& text) const {
    return boxesOf(*read("a.csv", text), 0);
  }
  /// Boxes of a frame of particles with the radius 0.5.
  [[nodiscard]] std::vector<Aabb> balls(const std::string& name, const std::string& text,
                                        std::uint32_t frame = 0) const {
    return boxesOf(*read(name, text, {{"radius", "0.5"}}), frame);
  }
};

TEST_F(TextImports, LinesEndInAnyWay) {
  for (const char* text : {"a\nb\n\nc", "a\r\nb\r\n\r\nc\r\n", "a\rb\r\rc\r",
                           "\xEF\xBB\xBF"
                           "a\nb\n\nc\n",
                           "a\r\r\nb\r\r\n\nc\n", "a\nb\r\rc\r\n", "a\rb\n\nc\n"}) {
    imports::LineReader lines(write("lines.txt", text));
    std::vector<std::string> found;
    while (lines.next()) found.emplace_back(lines.line());
    EXPECT_THAT(found, ElementsAre("a", "b", "", "c"));
    EXPECT_EQ(lines.number(), 4U);
    EXPECT_FALSE(lines.next());
  }
  EXPECT_THAT(complaint("utf16.csv", std::string("\xFF\xFE"
                                                 "0\0,\0",
                                                 6)),
              HasSubstr("UTF-8"));
}

TEST_F(TextImports, LongLinesAndPositions) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += fmt::format("{} {}\n", i, std::string(7 * i, 'x'));
  imports::LineReader lines(write("lines.txt", text));
  std::vector<imports::LineReader::Position> positions;
  for (int i = 0; i < 300; ++i) {
    positions.push_back(lines.position());
    ASSERT_TRUE(lines.next());
  }
  for (const int i : {299, 0, 150, 151, 7}) {
    lines.seek(positions[static_cast<std::size_t>(i)]);
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(lines.line(), fmt::format("{} {}", i, std::string(7 * i, 'x')));
    EXPECT_EQ(lines.number(), i + 1U);
  }
}

TEST_F(TextImports, NumbersAreReadInEveryLocale) {
  struct DecimalComma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const std::string c_before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "tr_TR.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  }
  const auto boxes = csv("0,0,.5,1e-320,-2.25E0,+1.5,1e-400,3.125e+1\n");
  std::setlocale(LC_ALL, c_before.c_str());
  std::locale::global(before);
  EXPECT_THAT(boxes, ElementsAre(boxOf({.5F, 0, -2.25F}, {1.5F, 0, 31.25F})));
}

TEST_F(TextImports, TinyNumbersAreNumbers) {
  EXPECT_THAT(csv("0,0,-1e-310,1e-45,0,1e-310,1e-39,0\n"),
              ElementsAre(boxOf({0, 1e-45F, 0}, {0, 1e-39F, 0})));
  EXPECT_THAT(balls("a.xyz", "1\n\nA 1e-320 -1e-400 0\n"), ElementsAre(testing::_));
  for (const char* text : {"+-5", "++5", "1e400", "-1e400", "0x10", "1.", ""}) {
    double number = 0;
    const bool is_number = imports::parseReal(text, number) && std::isfinite(number);
    EXPECT_EQ(is_number, std::string(text) == "1.") << text;
  }
}

TEST_F(TextImports, GzipIsUncompressed) {
  std::string text;
  for (int frame = 0; frame < 300; ++frame) text += fmt::format("1\n\nA {} 0 0\n", frame);
  for (const char* name : {"p.xyz.gz", "p.xyz", "p"}) {
    const auto frames = importFrom(compress(name, text), {{"radius", "0.5"}});
    EXPECT_EQ(frames->scene().name, "p");
    ASSERT_EQ(frames->scene().frames, 299U);
    EXPECT_THAT(boxesOf(*frames, 299), ElementsAre(ballAt(299, 0, 0)));
    EXPECT_THAT(boxesOf(*frames, 5), ElementsAre(ballAt(5, 0, 0)));
  }
  EXPECT_EQ(
      importFrom(compress("m.obj.gz", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))->scene().objects,
      1U);
  const std::string whole = readTextFile(compress("whole.xyz.gz", text));
  EXPECT_THAT(complaint("cut.xyz.gz", whole.substr(0, whole.size() - 9)),
              AllOf(HasSubstr("cut.xyz.gz"), HasSubstr("too early")));
  std::string damaged = whole;
  damaged[whole.size() - 6] ^= 1;
  EXPECT_THAT(complaint("damaged.xyz.gz", damaged), HasSubstr("damaged.xyz.gz: cannot read: gzip"));
}

TEST_F(TextImports, ACompressedMeshIsRecognisedByItsSize) {
  std::string stl(80, 's');
  stl += std::string("\1\0\0\0", 4) + std::string(50, '\0');
  EXPECT_EQ(importFrom(compress("mesh.gz", stl))->scene().objects, 1U);
}

TEST_F(TextImports, IntegersMayBeWrittenAsFloats) {
  EXPECT_THAT(csv("0.0,3e+00,1,2,3,4,5,6\n"), ElementsAre(boxOf({1, 2, 3}, {4, 5, 6})));
  EXPECT_THAT(complaint("a.csv", "0.5,3,1,2,3,4,5,6\n"), HasSubstr("the frame is '0.5'"));
  EXPECT_THAT(complaint("a.csv", "0,1e17,1,2,3,4,5,6\n"), HasSubstr("the id is '1e17'"));
}

// ---- CSV.

TEST_F(TextImports, CsvColumnsAreFoundByTheirNames) {
  const auto expected = ElementsAre(boxOf({1, 2, 3}, {4, 5, 6}), boxOf({7, 8, 9}, {10, 11, 12}));
  const std::string interleaved = "0,0,1,4,2,5,3,6\n0,1,7,10,8,11,9,12\n";
  for (const char* heading :
       {"frame,id,min_x,max_x,min_y,max_y,min_z,max_z", "FRAME,ID,xmin,xmax,ymin,ymax,zmin,zmax",
        "Frame, Id, minX, maxX, minY, maxY, minZ, maxZ",
        "frame,id,lower_x,upper_x,lower_y,upper_y,lower_z,upper_z",
        "frame,id,lowerBound.x,upperBound.x,lowerBound.y,upperBound.y,lowerBound.z,upperBound.z",
        "frame,id,xlo,xhi,ylo,yhi,zlo,zhi", "frame,body,x0,x1,y0,y1,z0,z1",
        "\"frame\",\"id\",\"aabb.min.x\",\"aabb.max.x\",\"aabb.min.y\",\"aabb.max.y\",\"aabb.min."
        "z\","
        "\"aabb.max.z\"",
        "frame,id,x_min (m),x_max (m),y_min (m),y_max (m),z_min (m),z_max (m)",
        "frame,id,x_min [m],x_max [m],y_min [m],y_max [m],z_min [m],z_max [m]",
        "\xEF\xBB\xBF"
        "# frame,id,min_x,max_x,min_y,max_y,min_z,max_z",
        "# a comment\n\nframe,id,min_x,max_x,min_y,max_y,min_z,max_z\n# another"}) {
    EXPECT_THAT(csv(std::string(heading) + "\n" + interleaved), expected) << heading;
  }
  EXPECT_THAT(csv("max_z,max_y,max_x,min_z,min_y,min_x\n6,5,4,3,2,1\n12,11,10,9,8,7\n"), expected);
  EXPECT_THAT(csv("id;min_x;min_y;min_z;max_x;max_y;max_z\n5;1;2;3;4;5;6\n9;7;8;9;10;11;12\n"),
              expected);
  EXPECT_THAT(
      csv("sep=;\nid;min_x;min_y;min_z;max_x;max_y;max_z\n5;1;2;3;4;5;6\n9;7;8;9;10;11;12\n"),
      expected);
  EXPECT_THAT(csv("0\t0\t1\t2\t3\t4\t5\t6\n0\t1\t7\t8\t9\t10\t11\t12\n"), expected);
  EXPECT_THAT(csv("centre_x,centre_y,centre_z,half_x,half_y,half_z\n"
                  "2.5,3.5,4.5,1.5,1.5,1.5\n8.5,9.5,10.5,1.5,1.5,1.5\n"),
              expected);
  EXPECT_THAT(csv("x,y,z,hx,hy,hz\n2.5,3.5,4.5,1.5,1.5,1.5\n8.5,9.5,10.5,1.5,1.5,1.5\n"), expected);
  EXPECT_THAT(csv("size_x,size_y,size_z,center_x,center_y,center_z\n"
                  "3,3,3,2.5,3.5,4.5\n3,3,3,8.5,9.5,10.5\n"),
              expected);
  EXPECT_THAT(csv("min_x,min_y,min_z,size_x,size_y,size_z\n1,2,3,3,3,3\n7,8,9,3,3,3\n,,,,,\n"),
              expected);
}

TEST_F(TextImports, BoxesOfACentreAreRoundedOutward) {
  const auto boxes =
      csv("centre_x,centre_y,centre_z,half_x,half_y,half_z\n"
          "1,0.1,16777217,1e-30,0.3,0\n");
  EXPECT_LT(boxes[0].min[0], 1);
  EXPECT_GT(boxes[0].max[0], 1);
  EXPECT_LE(double{boxes[0].min[1]}, 0.1 - 0.3);
  EXPECT_GE(double{boxes[0].max[1]}, 0.1 + 0.3);
  EXPECT_EQ(boxes[0].min[2], 16777216.F);
  EXPECT_EQ(boxes[0].max[2], 16777218.F);
}

TEST_F(TextImports, CsvFramesTimesAndLayers) {
  const auto timed = read("t.csv",
                          "time,id,layer,min_x,min_y,min_z,max_x,max_y,max_z\n"
                          "0.5,4,1,0,0,0,1,1,1\n0.5,2,0,2,0,0,3,1,1\n0.75,2,0,2,0,0,3,1,1\n");
  EXPECT_EQ(timed->scene().frames, 1U);
  EXPECT_THAT(boxesOf(*timed, 0),
              ElementsAre(boxOf({2, 0, 0}, {3, 1, 1}), boxOf({0, 0, 0}, {1, 1, 1})));
  EXPECT_EQ(timed->scene().filter.layerOf(0), 0U);
  EXPECT_EQ(timed->scene().filter.layerOf(1), 1U);
  EXPECT_TRUE(timed->scene().filter.wanted(0, 1));
  // Steps may be apart; numbers of frames that are missing are empty frames.
  const std::string rows = "0,0,0,0,1,1,1\n100,0,0,0,1,1,1\n";
  EXPECT_EQ(read("s.csv", "step,min_x,min_y,min_z,max_x,max_y,max_z\n" + rows)->scene().frames, 1U);
  const auto both = read("b.csv",
                         "step,time,min_x,min_y,min_z,max_x,max_y,max_z\n"
                         "0.1,0,0,0,0,1,1,1\n0.1,0.1,0,0,0,1,1,1\n");
  EXPECT_EQ(both->scene().frames, 1U) << "a step may be a duration";
  EXPECT_EQ(read("f.csv", "frame,min_x,min_y,min_z,max_x,max_y,max_z\n" + rows)->scene().frames,
            100U);
}

TEST_F(TextImports, WhatIsWrongWithColumnsOfCsv) {
  const auto wrong = [&](const std::string& text) { return complaint("a.csv", text); };
  const auto heading = [&](const std::string& names) { return wrong(names + "\n1,2,3,4,5,6\n"); };
  EXPECT_THAT(heading("min_x,min_y,min_z,max_x,max_y,mass"),
              AllOf(HasSubstr("no column max_z"), HasSubstr("mass")));
  EXPECT_THAT(heading("a,\x1B[31m,\xFF,d,e,f"), HasSubstr("a, \\u001b[31m, \uFFFD, d"));
  EXPECT_THAT(heading("a,b,c,d,e,f"), HasSubstr("the heading is 'a, b, c, d, e, f'"));
  EXPECT_THAT(heading("min_x,min_y,min_z,max_x,max_y,max_z,half_x"), HasSubstr("two forms"));
  EXPECT_THAT(heading("min_x,min_y,min_z,half_x,half_y,half_z"), HasSubstr("min_x and half_x"));
  EXPECT_THAT(heading("x,y,z,size_x,size_y,size_z"), HasSubstr("a corner or the centre"));
  EXPECT_THAT(heading("centre_x,centre_y,centre_z,extent_x,extent_y,extent_z"),
              HasSubstr("half or whole"));
  EXPECT_THAT(heading("min_x,xmin,min_z,max_x,max_y,max_z"), HasSubstr("'min_x' and 'xmin'"));
  EXPECT_THAT(heading("min_x min_y min_z max_x max_y max_z"), HasSubstr("commas"));
  EXPECT_THAT(wrong("0;0;0,5;0;0;1,5;1;1\n"),
              AllOf(HasSubstr("line 1"), HasSubstr("'0,5'"), HasSubstr("not a comma")));
  EXPECT_THAT(wrong("0,0,0,5,0,0,1,5,1,1\n"), AllOf(HasSubstr("10 values"), HasSubstr("comma")));
  EXPECT_THAT(wrong("x,y,z,hx,hy,hz\n0,0,0,1,-1,1\n"), HasSubstr("line 2: hy = -1 is negative"));
  EXPECT_THAT(wrong("x,y,z,hx,hy,hz\n1e39,0,0,1,1,1\n"), HasSubstr("32-bit"));
  const std::string timed = "time,id,min_x,min_y,min_z,max_x,max_y,max_z\n";
  EXPECT_THAT(wrong(timed + "1,0,0,0,0,1,1,1\n0,0,0,0,0,1,1,1\n"), HasSubstr("ascending"));
  const std::string layered = "frame,id,layer,min_x,min_y,min_z,max_x,max_y,max_z\n";
  EXPECT_THAT(wrong(layered + "0,0,32,0,0,0,1,1,1\n"), HasSubstr("no layer 32"));
  EXPECT_THAT(wrong(layered + "0,0,1,0,0,0,1,1,1\n1,0,2,0,0,0,1,1,1\n"),
              HasSubstr("line 3: 0 is in layer 2, before in 1"));
  const std::string box = "min_x,min_y,min_z,max_x,max_y,max_z\n";
  write("some/1.csv", "id,layer," + box + "0,1,0,0,0,1,1,1\n");
  write("some/2.csv", "id," + box + "0,0,0,0,1,1,1\n1,0,0,0,1,1,1\n");
  EXPECT_THAT(inputErrorOf([&] { importFrom(directory_ / "some"); }),
              HasSubstr("2.csv: line 2: only some files have layers"));
}

// ---- XYZ.

TEST_F(TextImports, KeysOfExtendedXyz) {
  const std::string atoms = "1 12 1 2 3\n2 16 4 5 6\n";
  const auto expected = ElementsAre(ballAt(1, 2, 3), ballAt(4, 5, 6));
  for (const char* comment :
       {"lattice=\"10 0 0 0 10 0 0 0 10\" properties=id:I:1:mass:R:1:pos:R:3",
        "PROPERTIES = \"id:I:1:mass:R:1:pos:R:3\" energy=5",
        "free text 'quoted = text' Properties=\tid:I:1:mass:R:1:POS:R:3 pbc=\"F F F\"",
        "it's text Properties={id:I:1:mass:R:1:pos:R:3}",
        "note=\"say \\\"x = y\\\" twice\" Properties=id:I:1:mass:R:1:pos:R:3",
        "virial=[[1, 2], [3, 4]] Properties =id:I:1:mass:R:1:pos:R:3 flag"}) {
    EXPECT_THAT(balls("a.xyz", fmt::format("2\n{}\n{}", comment, atoms)), expected) << comment;
  }
  const auto wrong = [&](const std::string& comment) {
    return complaint("a.xyz", fmt::format("2\n{}\n{}", comment, atoms), {{"radius", "1"}});
  };
  EXPECT_THAT(wrong("Properties=id:I:1:mass:R:1"), HasSubstr("pos:R:3"));
  EXPECT_THAT(wrong("Properties=id:I:1:mass:R:1:pos:R"), HasSubstr("NAME:TYPE:COLUMNS"));
  EXPECT_THAT(wrong("Properties=id:I:1:pos:R:3"), HasSubstr("5 columns: 4 are expected"));
  EXPECT_THAT(wrong("Properties=id:I:1:mass:R:1:id:I:3"), HasSubstr("'id' twice"));
  EXPECT_THAT(wrong("\"all Properties=pos:R:3 quoted\""), HasSubstr("a key of its own"));
}

TEST_F(TextImports, IdsOfExtendedXyz) {
  const std::string columns = "Properties=id:I:1:species:S:1:pos:R:3\n";
  const std::string first = "2\n" + columns + "1 H 1 2 3\n2 O 4 5 6\n";
  const std::string second = "2\n" + columns + "2 O 4 5 6\n1 H 1 2 3\n";
  const auto expected = ElementsAre(ballAt(1, 2, 3), ballAt(4, 5, 6));
  EXPECT_THAT(balls("a.xyz", first + second, 0), expected);
  EXPECT_THAT(balls("a.xyz", first + second, 1), expected);
  const std::string third = "1\n" + columns + "2 O 4 5 6\n";
  EXPECT_THAT(balls("a.xyz", first + third, 1), ElementsAre(kEmptyBox, ballAt(4, 5, 6)));
  EXPECT_THAT(complaint("a.xyz", first + "1\n\nA 1 2 3\n", {{"radius", "1"}}),
              HasSubstr("only some frames have ids"));
}

TEST_F(TextImports, ANumberOfParticlesMayVary) {
  const Source varying =
      source("a.xyz", "1\n\nA 1 2 3\n2\n\nA 1 2 3\nB 4 5 6\n0\n\n", {{"radius", "0.5"}});
  EXPECT_EQ(varying.imported->scene().objects, 2U);
  EXPECT_FALSE(varying.imported->scene().all_present);
  EXPECT_THAT(varying.summary.warnings, ElementsAre(HasSubstr("no ids")));
  const Source constant = source("b.xyz", "1\n\nA 1 2 3\n1\n\nA 1 2 3\n", {{"radius", "0.5"}});
  EXPECT_THAT(constant.summary.warnings, IsEmpty());
  EXPECT_THAT(constant.summary.used, testing::Contains(HasSubstr("no ids")));
}

// ---- LAMMPS.

/// A dump of a frame.
std::string dump(const std::string& bounds, const std::string& atoms) {
  return "ITEM: UNITS\nlj\nITEM: TIMESTEP\n0\nITEM: TIME\n0.5\nITEM: NUMBER OF ATOMS\n2\n"
         "ITEM: BOX BOUNDS " +
         bounds + "\nITEM: ATOMS " + atoms;
}

TEST_F(TextImports, BoxesOfLammps) {
  const std::string scaled = "id xs ys zs\n1 .1 .2 .3\n2 .4 .5 .6\n";
  const auto expected = ElementsAre(ballAt(1, 2, 3), ballAt(4, 5, 6));
  for (const char* cube : {"pp pp pp\n0 10\n0 10\n0 10", "\n0 10\n0 10\n0 10",
                           "abc origin pp pp pp\n10 0 0 0\n0 10 0 0\n0 0 10 0",
                           "xy xz yz ff ss mm\n0 10 0\n0 10 0\n0 10 0"}) {
    EXPECT_THAT(balls("a.dump", dump(cube, scaled)), expected) << cube;
  }
  EXPECT_THAT(balls("a.dump", dump("xy xz yz pp pp pp\n0 12 2\n0 10 0\n0 10 0",
                                   "id xs ys zs\n1 .25 .5 .75\n2 .4 .5 .6\n")),
              ElementsAre(ballAt(3.5F, 5, 7.5F), ballAt(5, 5, 6)));
  // xy = -2, xz = 1, yz = 3, from (1 1 1) by 10: the bounds are those of the cuboid around it.
  EXPECT_THAT(balls("a.dump", dump("xy xz yz pp pp pp\n-1 12 -2\n1 14 1\n1 11 3",
                                   "id xs ys zs\n1 0 0 0\n2 .5 .5 .5\n")),
              ElementsAre(ballAt(1, 1, 1), ballAt(5.5F, 7.5F, 6)));
  EXPECT_THAT(balls("a.dump", dump("abc origin pp pp pp\n0 8 0 1\n-4 0 0 2\n2 2 2 3",
                                   "id xs ys zs\n1 0 0 0\n2 .5 .5 .5\n")),
              ElementsAre(ballAt(1, 2, 3), ballAt(0, 7, 4)));
}

TEST_F(TextImports, PositionsOfLammps) {
  const auto expected = ElementsAre(ballAt(11, 2, 3), ballAt(4, 5, -14));
  const std::string cube = "pp pp pp\n0 10\n0 10\n0 10";
  for (const char* atoms : {"id x y z xu yu zu\n1 1 2 3 11 2 3\n2 4 5 6 4 5 -14\n",
                            "id xsu ysu zsu x y z\n1 1.1 .2 .3 1 2 3\n2 .4 .5 -1.4 4 5 6\n",
                            "id x y z ix iy iz\n1 1 2 3 1 0 0\n2 4 5 6 0 0 -2\n",
                            "iz ix id x y z\n0 1 1 1 2 3\n-2 0 2 4 5 6\n",
                            "id iz iy ix xs ys zs\n1 0 0 1 .1 .2 .3\n2 -2 0 0 .4 .5 .6\n"}) {
    EXPECT_THAT(balls("a.dump", dump(cube, atoms)), expected) << atoms;
  }
  // An image in a slanted box is moved by its edges.
  EXPECT_THAT(balls("a.dump", dump("xy xz yz pp pp pp\n0 12 2\n0 10 0\n0 10 0",
                                   "id x y z ix iy iz\n1 1 2 3 0 1 0\n2 0 0 0 -1 0 0\n")),
              ElementsAre(ballAt(3, 12, 3), ballAt(-10, 0, 0)));
}

TEST_F(TextImports, WhatIsNotReadOfLammps) {
  const std::string cube = "pp pp pp\n0 10\n0 10\n0 10";
  const std::string atoms = "type x y z\n1 1 2 3\n2 4 5 6\n";
  const auto wrong = [&](const std::string& text) {
    return complaint("a.dump", text, {{"radius", "1"}});
  };
  EXPECT_THAT(wrong("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n2\n"),
              HasSubstr("line 3: ITEM: 'NUMBER OF ENTRIES' is not read"));
  EXPECT_THAT(wrong("ITEM: ENTRIES c_1[1]\n5\n"), HasSubstr("'ENTRIES c_1[1]' is not read"));
  EXPECT_THAT(wrong("ITEM: TIMES\n5\n"), HasSubstr("'TIMES' is not read"));
  EXPECT_THAT(wrong(dump("triclinic\n0 10\n0 10\n0 10", atoms)), HasSubstr("'triclinic'"));
  EXPECT_THAT(wrong(dump("xy xz yz pp pp pp\n0 10\n0 10\n0 10", atoms)),
              HasSubstr("2 bounds of the box: 3"));
  EXPECT_THAT(wrong(dump(cube, "id x y z\n1 1 2 3 4\n2 4 5 6 7\n")), HasSubstr("5 columns: 4"));
  EXPECT_THAT(wrong(dump(cube, "id x x y z\n1 1 1 2 3\n2 4 4 5 6\n")), HasSubstr("columns 'x'"));
  EXPECT_THAT(wrong("ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x y z ix iy iz\n1 0 0 0 1 1 1\n"),
              HasSubstr("BOX BOUNDS"));
  const Source two = source("b.dump", dump(cube, atoms) + dump(cube, atoms), {{"radius", "1"}});
  EXPECT_EQ(two.summary.units, "lj");
  EXPECT_THAT(two.summary.warnings, ElementsAre(HasSubstr("no ids")));
}

// ---- Periodic boundaries.

TEST_F(TextImports, PeriodicBoxesAreTakenIfAskedFor) {
  const std::string atoms = "id x y z\n1 9.75 5 5\n2 10.5 5 -4\n";
  const auto periodic = [&](const std::string& name, const std::string& text) {
    Source read = source(name, text, {{"radius", "0.5"}, {"periodic", "source"}});
    EXPECT_THAT(read.summary.left_out, IsEmpty());
    EXPECT_EQ(read.reference.reading.at("periodic"), "source");
    EXPECT_EQ(read.reference.scene.periodic, read.imported->scene().periodic);
    const auto frames = adapted(std::move(read.imported), read.reference.reading);
    EXPECT_EQ(frames->scene(), read.reference.scene);
    EXPECT_THAT(
        boxesOf(*frames, 0),
        ElementsAre(ballAt(9.75F, 5, 5), testing::AnyOf(ballAt(.5F, 5, -4), ballAt(.5F, 5, 6))))
        << text;
    return periodicText(frames->scene().periodic);
  };
  EXPECT_EQ(periodic("a.dump", dump("pp pp ff\n0 10\n0 10\n0 10", atoms)), "0:10,0:10,-");
  EXPECT_EQ(periodic("a.dump", dump("xy xz yz pp ss ff\n0 10 0\n0 10 0\n0 10 0", atoms)),
            "0:10,-,-");
  EXPECT_EQ(periodic("a.dump", dump("abc origin pp pp pp\n10 0 0 0\n0 10 0 0\n0 0 10 0", atoms)),
            "0:10,0:10,0:10");
  const std::string lattice = "2\nLattice=\"10 0 0 0 8 0 0 0 10\" ";
  const std::string particles = "Properties=species:S:1:pos:R:3\nH 9.75 5 5\nH 10.5 5 -4\n";
  EXPECT_EQ(periodic("a.xyz", lattice + particles), "0:10,0:8,0:10") << "all, if pbc is not stated";
  EXPECT_EQ(periodic("a.xyz", lattice + "pbc=\"T F F\" " + particles), "0:10,-,-");
  EXPECT_EQ(periodic("a.xyz", lattice + "Origin=\"0 -1 0\" pbc=\"T T F\" " + particles),
            "0:10,-1:7,-");
}

TEST_F(TextImports, PeriodicBoundariesThatAreNotHonouredAreSaid) {
  const std::string atoms = "id x y z\n1 9.75 5 5\n2 10.5 5 -4\n";
  const std::string frame = dump("pp pp ff\n0 10\n0 10\n0 10", atoms);
  const auto wrong = [&](const std::string& name, const std::string& text) {
    return inputErrorOf([&] {
      static_cast<void>(source(name, text, {{"radius", "0.5"}, {"periodic", "source"}}));
    });
  };
  EXPECT_THAT(source("a.dump", frame, {{"radius", "0.5"}}).summary.left_out,
              ElementsAre(HasSubstr("--periodic")));
  EXPECT_THAT(
      source("a.dump", frame, {{"radius", "0.5"}, {"periodic", "0:10,-,-"}}).summary.left_out,
      IsEmpty());
  EXPECT_THAT(wrong("a.dump", frame + dump("pp pp ff\n0 11\n0 10\n0 10", atoms)),
              HasSubstr("the periodic box is 0:11,0:10,-, but 0:10,0:10,- in the frames before"));
  EXPECT_THAT(wrong("a.dump", dump("xy xz yz pp pp pp\n0 12 2\n0 10 0\n0 10 0", atoms)),
              HasSubstr("slanted"));
  EXPECT_THAT(wrong("a.dump", dump("pp pp pp\n0 0\n0 10\n0 10", atoms)), HasSubstr("no extent"));
  EXPECT_THAT(wrong("a.dump", dump("ff ff ff\n0 10\n0 10\n0 10", atoms)),
              HasSubstr("states no periodic box"));
  for (const char* silent : {"\n0 10\n0 10\n0 10", "ff ff ff\n0 10\n0 10\n0 10"}) {
    EXPECT_THAT(wrong("a.dump", frame + dump(silent, atoms)),
                HasSubstr("the periodic box is -,-,-"));
  }
  const std::string particles = "Properties=species:S:1:pos:R:3\nH 9.75 5 5\n";
  EXPECT_THAT(wrong("a.xyz", "1\nLattice=\"9 0 0 0 9 0 0 0 9\" " + particles + "1\n" + particles),
              HasSubstr("the periodic box is -,-,-"));
  EXPECT_THAT(wrong("a.xyz", "1\npbc=\"T T T\" " + particles), HasSubstr("Lattice"));
  EXPECT_THAT(wrong("a.xyz", "1\nLattice=\"1 2 3\" " + particles), HasSubstr("9 numbers"));
  EXPECT_THAT(wrong("a.xyz", "1\n" + particles), HasSubstr("states no periodic box"));
}

// ---- What was understood.

TEST_F(TextImports, WhatWasUnderstoodIsSaid) {
  const std::string heading = "id,min_x,min_y,min_z,max_x,max_y,max_z";
  const Source left_out = source("a.csv", heading + ",mass\n1,0,0,0,1,2,3,5\n");
  EXPECT_THAT(
      importText(left_out),
      AllOf(HasSubstr(
                "a.csv: CSV: 1 body (boxes), initial pose and 0 frames, box (0 0 0) to (1 2 3)"),
            HasSubstr("used: columns id, min_x"), HasSubstr("left out: columns mass")));
  EXPECT_THAT(inputErrorOf([&] {
                static_cast<void>(
                    source("a.csv", heading + ",mass\n1,0,0,0,1,2,3,5\n", {{"strict", "on"}}));
              }),
              AllOf(HasSubstr("--strict"), HasSubstr("mass")));
  const Source whole = source("b.csv", heading + "\n1,0,0,0,1,2,3\n", {{"strict", "on"}});
  EXPECT_THAT(importText(whole), Not(HasSubstr("left out")));
  EXPECT_THAT(whole.reference.reading, IsEmpty()) << "the frames are the same";
  EXPECT_THAT(
      source("c.dump", dump("ff ff ff\n0 10\n0 10\n0 10", "id vx x y z\n1 9 1 2 3\n2 9 4 5 6\n"),
             {{"radius", "1"}})
          .summary.left_out,
      ElementsAre("columns vx"));
}

}  // namespace
}  // namespace broadmark::tests
