// Kinds of imported files, recognised by their contents, and the files that a name refers to.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "app/import_files.h"
#include "imports/mesh_format.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kDump =
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\n"
    "ITEM: ATOMS id x y z\n1 1 2 3\n";
constexpr const char* kObj = "# mesh\n\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A binary STL file of one triangle, and bytes behind it.
std::string binaryStl(std::size_t more) {
  std::string bytes = "solid by name only";
  bytes.resize(84 + 50 + more);
  bytes[80] = 1;
  return bytes;
}

class Recognition : public Imports {
 protected:
  /// The format by which a file is imported; "": not at all.
  [[nodiscard]] std::string formatOf(const std::string& name, const std::string& text) const {
    const auto import = importOf(write(name, text).string());
    return import ? import->formats.front() : "";
  }
  [[nodiscard]] std::string meshOf(const std::string& name, const std::string& text) const {
    return imports::meshFormat(write(name, text), "auto");
  }
};

TEST_F(Recognition, ByContentWhateverTheName) {
  for (const char* name : {"dump.100", "a.dat", "a", "a.csv", "a.obj", "a.json", "a.lammpsdump"}) {
    EXPECT_EQ(formatOf(name, kDump), "lammps") << name;
    EXPECT_EQ(formatOf(name, "\xEF\xBB\xBF\r\n 1 \r\n\r\nA 1 2 3\r\n"), "xyz") << name;
    EXPECT_EQ(formatOf(name, "1\r\rA 1 2 3\r"), "xyz") << name;
    EXPECT_EQ(formatOf(name, "0\nempty\n"), "xyz") << name;
    EXPECT_EQ(formatOf(name, "0;0;0;0;0;1;1;1\n"), "csv") << name;
    EXPECT_EQ(formatOf(name, "# from a program\nname\tx_min\tx_max\ty_min\ty_max\tz_min\tz_max\n"),
              "csv")
        << name;
    EXPECT_EQ(formatOf(name, kObj), "ply") << name << ": meshes";
  }
  for (const char* text : {"hello\n", "{}", "[1, 2, 3]", "1\n2\n3\n", "v\n", "solid ground\n",
                           "1,2,3\n", "frame,value\n1,2\n", ""}) {
    EXPECT_EQ(formatOf("a.dat", text), "") << text;
  }
}

TEST_F(Recognition, ByNameIfTheContentIsUnknown) {
  EXPECT_EQ(formatOf("a.csv", "hello\n"), "csv");
  EXPECT_EQ(formatOf("a.CSV", "frame,value\n"), "csv");
  EXPECT_EQ(formatOf("a.XYZ.gz", ""), "xyz");
  EXPECT_EQ(formatOf("a.aabbs", kDump), "") << "a recording";
  EXPECT_THAT(complaint("a.dump", "hello\n"), HasSubstr("'ITEM: …' is expected"));
}

TEST_F(Recognition, MeshFormats) {
  for (const char* name : {"a", "a.stl", "a.ply"}) {
    EXPECT_EQ(meshOf(name, "ply\r\nformat ascii 1.0\n"), "ply");
    EXPECT_EQ(meshOf(name, kObj), "obj");
    EXPECT_EQ(meshOf(name, "v 0 0 0\nv 1 1 1\nl 1 2\n"), "obj");
    EXPECT_EQ(meshOf(name, "\n SOLID\n FACET NORMAL 0 0 1\n"), "stl");
    EXPECT_EQ(meshOf(name, binaryStl(0)), "stl");
    EXPECT_EQ(meshOf(name, "glTF\2"), "gltf");
    EXPECT_EQ(meshOf(name, R"( {"asset": {"version": "2.0"}})"), "gltf");
  }
  EXPECT_EQ(meshOf("a.stl", binaryStl(3)), "stl");
  EXPECT_EQ(meshOf("a.dat", binaryStl(3)), "");
  EXPECT_EQ(meshOf("a.gltf", "hello"), "gltf");
  EXPECT_EQ(meshOf("a.json", R"({"schema": "x", "asset": 1, "version": 2})"), "");
  EXPECT_EQ(imports::meshFormat(write("a.stl", kObj), "obj"), "obj");
}

TEST_F(Recognition, AStatedFormatOverrides) {
  EXPECT_THAT(complaint("a.xyz", kDump, {{"format", "csv"}}), HasSubstr("a.xyz: line 1"));
  ReadingOptions reading;
  setParameters(reading, {{"format", "lammps"}, {"radius", "1"}});
  const auto reading_of = [&](const std::string& name) {
    return fileSource({write(name, kDump).string()}, reading).reference.reading;
  };
  EXPECT_EQ(reading_of("a.csv"), (ParameterValues{{"radius", "1"}})) << "as recognised";
  reading.format.value = "csv";
  reading.radius = 0;
  const auto csv = fileSource({write("b.dat", "0,0,0,0,0,1,1,1\n").string()}, reading);
  EXPECT_EQ(csv.reference.scene.objects, 1U);
  // Every format has a reader.
  for (const std::string& format : ReadingOptions().format.options) {
    if (format == "auto") continue;
    EXPECT_TRUE(importOf("any", format)) << format;
  }
}

TEST_F(Recognition, FilesOfAFolder) {
  write("run/dump.0", kDump);
  write("run/dump.100", kDump);
  write("run/dump.20", kDump);
  write("run/.dump.5", "hidden");
  write("run/log.lammps", "LAMMPS (2 Aug 2023)\n");
  write("run/thermo.csv", "step,energy\n0,5\n");
  const auto frames = importFrom(directory_ / "run", {{"radius", "1"}});
  EXPECT_EQ(frames->scene().name, "dump");
  EXPECT_EQ(frames->scene().frames, 2U);
  // A damaged file of a sequence is not left out.
  write("meshes/a1.obj", kObj);
  write("meshes/a2.obj", "");
  EXPECT_THAT(inputErrorOf([&] { importFrom(directory_ / "meshes"); }), HasSubstr("a2.obj"));
  write("both/a.obj", kObj);
  write("both/a.xyz", "1\n\nA 1 2 3\n");
  EXPECT_THAT(inputErrorOf([&] { importFrom(directory_ / "both"); }),
              AllOf(HasSubstr("both"), HasSubstr("pattern")));
  EXPECT_FALSE(importOf((directory_ / "none").string()));
}

TEST_F(Recognition, FilesOfOneKind) {
  write("a1.xyz", "1\n\nA 1 2 3\n");
  write("a2.xyz", kDump);
  EXPECT_THAT(inputErrorOf([&] { importFrom(directory_ / "a*.xyz", {{"radius", "1"}}); }),
              AllOf(HasSubstr("a2.xyz"), HasSubstr("xyz is expected")));
}

TEST_F(Recognition, PatternsBelowFoldersWithBrackets) {
  write("run [1]/a?/b1.xyz", "1\n\nA 1 2 3\n");
  write("run [1]/a?/b2.xyz", "1\n\nA 1 2 3\n");
  write("run [1]/ab/b3.xyz", "1\n\nA 1 2 3\n");
  const auto frames_of = [&](const std::string& pattern) {
    return importFrom(directory_ / pattern, {{"radius", "1"}})->scene().frames + 1;
  };
  EXPECT_EQ(frames_of("run [1]/a?/b*.xyz"), 2U);
  EXPECT_EQ(frames_of("run [1]/a*/b[2-3].xyz"), 2U);
  EXPECT_EQ(frames_of("run [1]/a?/b1.xyz"), 1U);
}

TEST_F(Recognition, UnknownFilesAreRefusedWithWhatIsRead) {
  const auto open = [&](const std::string& name, const std::string& text) {
    const auto path = write(name, text).string();
    return inputErrorOf([&] { openSource(path, {}); });
  };
  EXPECT_THAT(open("a.dat", "hello"), AllOf(HasSubstr("a.dat"), HasSubstr(".xyz"),
                                            HasSubstr(".aabbs"), HasSubstr("--format")));
  EXPECT_THAT(inputErrorOf([&] { openSource((directory_ / "missing.dat").string(), {}); }),
              HasSubstr("No such file"));
  std::filesystem::create_directory(directory_ / "empty");
  EXPECT_THAT(inputErrorOf([&] { openSource((directory_ / "empty").string(), {}); }),
              HasSubstr("holds no file"));
  const auto reason = [&](const std::string& name) {
    return inputErrorOf([&] { throw notImported((directory_ / name).string()); });
  };
  EXPECT_THAT(reason("empty"), AllOf(HasSubstr("holds no file"), HasSubstr(".xyz")));
  EXPECT_THAT(reason("a.dat"), HasSubstr("no known format"));
  EXPECT_THAT(reason("missing.dat"), HasSubstr("No such file"));
  EXPECT_THAT(reason("missing*.dat"), HasSubstr("matches no file"));
}

}  // namespace
}  // namespace broadmark::tests
