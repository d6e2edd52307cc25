// Files of other programs, and swept boxes, from the command line to the results.

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

using Import = EndToEnd;

/// Three boxes in a row: the first two touch, the last appears, the first vanishes.
constexpr const char* kCsv =
    "frame,id,x0,y0,z0,x1,y1,z1\n"
    "0,0,0,0,0,1,1,1\n0,1,1,0,0,2,1,1\n"
    "1,0,0,0,0,1,1,1\n1,1,5,0,0,6,1,1\n1,2,3,0,0,4,1,1\n"
    "2,1,5,0,0,6,1,1\n2,2,3,0,0,4,1,1\n";

/// The number of pairs per frame, in a results file with one case.
std::vector<int> pairsOf(const fs::path& results) {
  return readJson(results)["cases"][0]["frame_counts"]["pairs"].get<std::vector<int>>();
}

TEST_F(Import, RunsOnFilesDirectly) {
  writeFile(file("boxes.csv"), kCsv);
  runQuietly(
      {"--headless", "boxes.csv", "--algorithm", "sap", "--check", "full", "--json", "r.json"});
  EXPECT_THAT(pairsOf(file("r.json")), ElementsAre(0, 0));
  // In frame 1 body 1 passes body 2.
  runQuietly({"--headless", "boxes.csv", "--swept", "--algorithm", "sap", "--check", "full",
              "--json", "s.json"});
  EXPECT_THAT(pairsOf(file("s.json")), ElementsAre(2, 0));
}

TEST_F(Import, ResultsTellHowTheSourceWasRead) {
  writeFile(file("p.xyz"), "1\n\nA 0 0 0\n1\n\nA 1 0 0\n");
  runQuietly({"--headless", "p.xyz", "--radius", "0.5", "--swept", "--algorithm", "sap", "--json",
              "r.json"});
  const Json result = readJson(file("r.json"))["cases"][0];
  const Json recording = result["recording"];
  EXPECT_EQ(recording["name"], "p swept");
  EXPECT_EQ(recording["source"], "p.xyz");
  EXPECT_EQ(recording["reading"], Json::parse(R"({"radius": "0.5", "swept": "on"})"));
  EXPECT_EQ(result["id"], "p swept/Particles/N1/F1/radius=0.5/sap");

  runQuietly({"--headless", "p.xyz", "--radius", "0.5", "--algorithm", "sap", "--json", "u.json"});
  EXPECT_NE(readJson(file("u.json"))["cases"][0]["recording"]["hash"], recording["hash"]);

  // The same case again: it is opened with the same options, and its hash is checked.
  runQuietly({"--headless", "r.json", "--case", result["id"], "--json", "again.json"});
  EXPECT_EQ(readJson(file("again.json"))["cases"][0]["recording"], recording);
  writeFile(file("p.xyz"), "1\n\nA 0 0 0\n1\n\nA 2 0 0\n");
  expectRefusal({"--headless", "r.json", "--quiet", "--case", result["id"]}, {"p.xyz", "hash"});
}

TEST_F(Import, ScenesAndRecordingsCanBeSwept) {
  const Arguments scene = {"brownian",    "--objects",     "40",      "--frames", "4",
                           "--algorithm", "sap,kd,dbvt-f", "--check", "full"};
  const auto with = [&](const Arguments& more) {
    Arguments call = {"--headless"};
    call.insert(call.end(), scene.begin(), scene.end());
    call.insert(call.end(), more.begin(), more.end());
    return call;
  };
  runQuietly(with({"--swept", "--json", "swept.json"}));
  const Json swept = readJson(file("swept.json"))["cases"];
  ASSERT_EQ(swept.size(), 3U);
  for (const Json& result : swept) EXPECT_EQ(result["status"], "ok") << result["algorithm"];
  runQuietly({"--headless", "swept.json", "--case", swept[0]["id"], "--json", "again.json"});
  // A stored recording is the scene's, not swept; swept again, it gives the same results.
  runQuietly(with({"--record", "out"}));
  const std::string kept = recordingIn("out", "Brownian Cubes N40 F4frames");
  runQuietly({"--headless", kept, "--swept", "--algorithm", "sap", "--json", "file.json"});
  EXPECT_EQ(readJson(file("file.json"))["cases"][0]["recording"]["hash"],
            swept[0]["recording"]["hash"]);
  const ProgramResult described = run({"verify", kept, "--swept", "--describe"});
  EXPECT_EQ(described.status, 0) << described.err;
  EXPECT_THAT(described.out, HasSubstr("Brownian swept Cubes"));
  const ProgramResult duel =
      run({"duel", kept, "sap", "bf", "--swept", "--max-seconds", "0.3", "--json", "-"});
  EXPECT_EQ(duel.status, 0) << duel.err;
  EXPECT_THAT(duel.out, HasSubstr("Brownian swept"));
}

TEST_F(Import, AnySourceCanBeWidened) {
  // The first two boxes touch, the third is a unit from the second.
  writeFile(file("boxes.csv"), kCsv);
  const auto pairs_at = [&](const std::string& distance, const Arguments& more = {}) {
    Arguments call = {"--headless", "boxes.csv",   "--widen",
                      distance,     "--algorithm", "sap,kd,dbvt-f,tracy,grid-bf,columns,tide",
                      "--check",    "full",        "--json",
                      "w.json"};
    call.insert(call.end(), more.begin(), more.end());
    runQuietly(call);
    const Json cases = readJson(file("w.json"))["cases"];
    for (const Json& result : cases) {
      EXPECT_EQ(result["status"], "ok") << result["algorithm"];
    }
    return pairsOf(file("w.json"));
  };
  EXPECT_THAT(pairs_at("0.99"), ElementsAre(0, 0));
  EXPECT_THAT(pairs_at("1"), ElementsAre(1, 1));
  EXPECT_THAT(pairs_at("2"), ElementsAre(2, 1));
  // One pair at first; then two begin, and as many end.
  EXPECT_THAT(pairs_at("1e30", {"--answer", "events", "--threads", "2"}), ElementsAre(2, 2));

  const Json result = readJson(file("w.json"))["cases"][0];
  EXPECT_EQ(result["recording"]["reading"], Json::parse(R"({"widen": "1e+30"})"));
  EXPECT_EQ(result["recording"]["name"], "boxes widened");
  EXPECT_THAT(result["id"].get<std::string>(), HasSubstr("boxes widened/Boxes/N3/F2/widen=1e+30/"));
  runQuietly({"--headless", "w.json", "--case", result["id"], "--json", "again.json"});
  EXPECT_EQ(readJson(file("again.json"))["cases"][0]["recording"], result["recording"]);

  // Imported so, they are boxes like any others; and so are those of scenes.
  EXPECT_EQ(run({"import", "boxes.csv", "--widen", "1", "-o", "wide"}).status, 0);
  runQuietly({"--headless", "wide.broadmark", "--algorithm", "sap", "--json", "i.json"});
  EXPECT_THAT(pairsOf(file("i.json")), ElementsAre(1, 1));
  runQuietly({"--headless", "brownian", "--objects", "40", "--frames", "4", "--swept", "--widen",
              "0.25", "--algorithm", "sap,bf-simd,axis-sweep,dbvt-d", "--check", "full", "--json",
              "b.json"});
  const Json scene = readJson(file("b.json"))["cases"][0];
  EXPECT_EQ(scene["recording"]["name"], "Brownian swept widened");
  runQuietly({"--headless", "b.json", "--case", scene["id"], "--json", "c.json"});
  EXPECT_THAT(run({"verify", "boxes.csv", "--widen", "2", "--describe"}).out,
              HasSubstr("boxes widened"));
  const ProgramResult duel = run({"duel", "wide.broadmark", "sap", "bf", "--widen", "1",
                                  "--max-seconds", "0.3", "--json", "-"});
  EXPECT_EQ(duel.status, 0) << duel.err;
  EXPECT_THAT(duel.out, HasSubstr("wide"));

  for (const std::string wrong : {"-1", "nan", "inf", "1e39", "far", ""}) {
    expectRefusal({"--headless", "boxes.csv", "--widen", wrong, "--algorithm", "sap"}, {"--widen"});
  }
}

TEST_F(Import, BodiesAreNumberedInAnotherOrder) {
  const auto run_with = [&](Arguments order) {
    Arguments call = {"--headless", "fountain", "--objects",   "60",
                      "--frames",   "30",       "--algorithm", "sap,tide,columns",
                      "--check",    "full",     "--json",      file("o.json").string()};
    call.insert(call.end(), order.begin(), order.end());
    runQuietly(call);
    return pairsOf(file("o.json"));
  };
  const auto pairs = run_with({});
  for (const std::string order : {"random", "morton"}) {
    EXPECT_EQ(run_with({"--body-order", order}), pairs);
    const Json result = readJson(file("o.json"))["cases"][0];
    EXPECT_EQ(result["recording"]["name"], "Fountain reordered");
    EXPECT_EQ(result["recording"]["reading"], (Json{{"body_order", order}}));
    runQuietly({"--headless", "o.json", "--case", result["id"], "--json", "again.json"});
    EXPECT_EQ(readJson(file("again.json"))["cases"][0]["recording"], result["recording"]);
  }
  expectRefusal({"--headless", "fountain", "--body-order", "hilbert"}, {"--body-order", "morton"});
}

TEST_F(Import, PairsAcrossPeriodicBoundariesAreFound) {
  // The first two atoms meet across the x faces, in the second frame also the last two across z.
  const auto frame = [](const std::string& atoms) {
    return "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n"
           "0 10\nITEM: ATOMS id x y z radius\n" +
           atoms;
  };
  const std::string first = frame("1 .2 5 5 .5\n2 9.8 5 5 .5\n3 5 2 5 .5\n4 5 2 .25 .5\n");
  writeFile(file("a.dump"), first + first +
                                frame("1 10.2 5 5 .5\n2 9.8 5 5 .5\n3 5 2 9.25 .5\n"
                                      "4 5 2 .25 .5\n"));
  const auto pairs_with = [&](Arguments call) {
    for (const char* more : {"--headless", "--algorithm", "bf,kd,tide,columns,dbvt-d", "--check",
                             "full", "--json", "p.json"})
      call.emplace_back(more);
    runQuietly(call);
    const Json results = readJson(file("p.json"));
    for (const Json& result : results["cases"]) {
      EXPECT_THAT(result["status"], testing::AnyOf("ok", "unsupported")) << result["algorithm"];
    }
    return pairsOf(file("p.json"));
  };
  EXPECT_THAT(pairs_with({"a.dump"}), ElementsAre(0, 1));
  EXPECT_THAT(pairs_with({"a.dump", "--periodic"}), ElementsAre(1, 2));
  EXPECT_THAT(pairs_with({"a.dump", "--periodic", "--answer", "events"}), ElementsAre(0, 1));
  EXPECT_THAT(pairs_with({"a.dump", "--periodic=0:10,-,-"}), ElementsAre(1, 1));
  EXPECT_THAT(pairs_with({"a.dump", "--periodic", "--widen", "0.1"}), ElementsAre(1, 2));

  // Recordings keep the box, and results the option.
  EXPECT_EQ(run({"import", "a.dump", "--periodic", "-o", "a"}).status, 0);
  EXPECT_THAT(pairs_with({"a.broadmark"}), ElementsAre(1, 2));
  pairs_with({"a.dump", "--periodic"});
  const Json result = readJson(file("p.json"))["cases"][0];
  EXPECT_EQ(result["recording"]["reading"], Json::parse(R"({"periodic": "source"})"));
  runQuietly({"--headless", "p.json", "--case", result["id"], "--json", "again.json"});
  EXPECT_EQ(readJson(file("again.json"))["cases"][0]["recording"], result["recording"]);

  // A scene in a box of its own; and what cannot be.
  pairs_with({"brownian", "--objects", "300", "--frames", "3", "--periodic=-2:2,-2:2,-2:2"});
  expectRefusal({"--headless", "brownian", "--periodic"}, {"Brownian", "--periodic=0:10"});
  expectRefusal({"--headless", "brownian", "--periodic=1:0,-,-"}, {"--periodic", "'1:0,-,-'"});
  expectRefusal({"--headless", "a.broadmark", "--periodic=0:1,-,-"}, {"is periodic already"});
  expectRefusal({"--headless", "a.dump", "--periodic", "--swept"}, {"--swept", "not both"});
  expectRefusal({"import", "a.dump", "--periodic", "-o", "a.aabbs"}, {"periodic boxes"});
}

TEST_F(Import, MakesRecordings) {
  writeFile(file("boxes.csv"), kCsv);
  EXPECT_EQ(run({"import", "boxes.csv", "-o", "boxes"}).status, 0);
  EXPECT_TRUE(fs::exists(file("boxes.broadmark"))) << "a body is absent";
  runQuietly({"--headless", "boxes.broadmark", "--algorithm", "sap,tracy", "--check", "full"});
  expectRefusal({"import", "boxes.csv", "-o", "no.aabbs"}, {"no.aabbs"});
  expectRefusal({"import", "boxes.csv", "-o", "no.txt"}, {"no.txt", ".broadmark"});

  for (const int frame : {9, 10}) {
    writeFile(file("m" + std::to_string(frame) + ".obj"),
              "v " + std::to_string(frame) + " 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  EXPECT_EQ(run({"import", "m10.obj", "m9.obj", "--keep", "shared-vertices", "-o", "m"}).status, 0);
  EXPECT_TRUE(fs::exists(file("m.aabbs"))) << "all pairs of bodies that are always there";
  EXPECT_THAT(run({"verify", "m.aabbs"}).out, HasSubstr("m Triangles, 1 body, 1 frame"));
  EXPECT_THAT(run({"verify", "m*.obj", "--elements", "edges"}).out, HasSubstr("m Edges, 3 bodies"));
}

TEST_F(Import, SaysWhatItUnderstood) {
  writeFile(file("mass.csv"),
            "frame,id,mass,min_x,min_y,min_z,max_x,max_y,max_z\n"
            "0,0,5,0,0,0,1,1,1\n1,0,5,0,0,0,1,1,2\n");
  const auto is_said = [&](const std::string& text) {
    EXPECT_THAT(text,
                HasSubstr("mass.csv: CSV: 1 body (boxes), initial pose and 1 frame, box (0 0 0) to "
                          "(1 1 2), units not stated\n"));
    EXPECT_THAT(text, HasSubstr("used: columns frame, id, min_x"));
    EXPECT_THAT(text, HasSubstr("left out: columns mass"));
  };
  is_said(run({"import", "mass.csv", "-o", "mass.broadmark"}).err);
  is_said(run({"--headless", "mass.csv", "--algorithm", "sap"}).err);
  is_said(run({"verify", "mass.csv"}).err);
  is_said(run({"verify", "mass.broadmark"}).out);
  EXPECT_EQ(runQuietly({"import", "mass.csv", "-o", "quiet"}).err, "");
  expectRefusal({"import", "mass.csv", "--strict", "-o", "no"}, {"mass.csv", "--strict", "mass"});
  expectRefusal({"--headless", "mass.csv", "--strict"}, {"mass.csv", "--strict", "mass"});
  writeFile(file("boxes.csv"), kCsv);
  runQuietly({"--headless", "boxes.csv", "--strict", "--algorithm", "sap"});
  expectRefusal({"--headless", "freefall", "--strict", "--objects", "5"}, {"--strict"});
}

TEST_F(Import, ReadsPipesAndCompressedFiles) {
  writeFile(file("boxes.csv"), kCsv);
  const std::string options = " --algorithm sap --check full --quiet --json ";
  ASSERT_EQ(shell("gzip -k boxes.csv && mv boxes.csv.gz named.dat && mkfifo fifo"), 0);
  EXPECT_EQ(shell("broadmark --headless named.dat" + options + "gz.json"), 0);
  EXPECT_EQ(shell("cat boxes.csv | broadmark --headless -" + options + "pipe.json"), 0);
  EXPECT_EQ(shell("cat named.dat | broadmark --headless /dev/stdin" + options + "stdin.json"), 0);
  EXPECT_EQ(shell("broadmark --headless - " + options + "file.json < boxes.csv"), 0);
  EXPECT_EQ(shell("(cat boxes.csv > fifo &) && broadmark --headless fifo" + options + "fifo.json"),
            0);
  for (const char* name : {"gz.json", "pipe.json", "stdin.json", "file.json", "fifo.json"}) {
    EXPECT_THAT(pairsOf(file(name)), ElementsAre(0, 0)) << name;
  }
  EXPECT_EQ(shell("cat boxes.csv | broadmark import - -o piped --quiet"), 0);
  EXPECT_EQ(shell("broadmark verify piped.broadmark --quiet"), 0);
  EXPECT_EQ(shell("echo hello | broadmark --headless - --quiet"), 2);
}

TEST_F(Import, OneFrameIsNothingToRun) {
  writeFile(file("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expectRefusal({"--headless", "m.obj", "--algorithm", "sap"}, {"m.obj", "nothing to run"});
  runQuietly({"import", "m.obj", "-o", "m.broadmark"});
  expectRefusal({"--headless", "m.broadmark", "--algorithm", "sap"},
                {"m.broadmark", "nothing to run"});
}

TEST_F(Import, AMissingFolderForTemporaryFilesIsNamed) {
  writeFile(file("boxes.csv"), kCsv);
  expectRefusal({"--headless", "boxes.csv", "--algorithm", "sap", "--quiet"},
                {"TMPDIR", "/no/such"}, {.environment = {{"TMPDIR", "/no/such"}}});
}

TEST_F(Import, BadCalls) {
  writeFile(file("boxes.csv"), kCsv);
  writeFile(file("bad.csv"), "0,0,0,0,0,1,1\n");
  writeFile(file("p.xyz"), "1\n\nA 0 0 0\n");
  const Arguments run_on = {"--headless", "--algorithm", "sap", "--quiet"};
  const auto on = [&](const Arguments& more) {
    Arguments call = run_on;
    call.insert(call.end(), more.begin(), more.end());
    return call;
  };
  expectRefusal(on({"bad.csv"}), {"bad.csv", "line 1", "8 are expected"});
  expectRefusal(on({"p.xyz"}), {"p.xyz", "--radius"});
  expectRefusal(on({"boxes.csv", "--elements", "edges"}), {"--elements"});
  expectRefusal(on({"freefall", "--radius", "1"}), {"--radius"});
  expectRefusal(on({"boxes.csv", "--elements", "edge"}), {"--elements", "'edge'"});
  expectRefusal(on({"boxes.csv", "--keep", "all"}), {"--keep", "'all'"});
  expectRefusal(on({"*.ply"}), {"*.ply"});
  expectRefusal({"import", "boxes.csv", "p.xyz", "-o", "no.aabbs"}, {"p.xyz", ".csv"});
  expectRefusal({"import", "freefall", "-o", "no.aabbs"}, {"freefall", ".csv"});
  expectRefusal({"import", "bad.csv", "-o", "no.aabbs"}, {"bad.csv", "line 1"});
  expectRefusal({"import", "boxes.csv", "-o", "none/no.broadmark"}, {"none/no.broadmark"});
}

}  // namespace
}  // namespace broadmark::tests
