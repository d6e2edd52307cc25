// Compute devices: listing, selection and absence.

#include "broadmark/compute_devices.h"
#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class Device : public EndToEnd {
 protected:
  void SetUp() override {
    if (computeDevices().empty()) GTEST_SKIP() << "no OpenCL device";
  }
  /// A short run of an algorithm on a device and of another on the CPU.
  const Arguments short_run_ = {"--headless", "freefall", "--objects",   "50",
                                "--frames",   "2",        "--algorithm", "gpu-sap,sap",
                                "--json",     "r.json",   "--quiet"};
};

TEST_F(Device, AreListed) {
  const ProgramResult ended = run({"list", "devices"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(onOneLine(ended.out), HasSubstr("0: " + describe(computeDevices().front())));
}

TEST_F(Device, IsChosenByNumberOrNameAndRecorded) {
  const std::string name = computeDevices().front().name;
  for (const std::string& wanted : {std::string("0"), name}) {
    Arguments arguments = short_run_;
    arguments.insert(arguments.end(), {"--device", wanted});
    EXPECT_EQ(run(arguments).status, 0);
    const Json devices = readJson(file("r.json")).at("environments").at(0).at("compute_devices");
    EXPECT_EQ(devices.at(0), describe(computeDevices().front()));
  }
}

TEST_F(Device, UnknownOnesAreRefused) {
  Arguments arguments = short_run_;
  arguments.insert(arguments.end(), {"--device", "nothing like it"});
  expectRefusal(arguments, {"'nothing like it'", "0: "});
}

TEST_F(Device, WithoutAnIcdEverythingElseRuns) {
  const ProgramResult ended =
      run(short_run_, {.environment = {{"OCL_ICD_VENDORS", "/nonexistent/"}}});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const Json results = readJson(file("r.json"));
  EXPECT_THAT(results.at("environments").at(0).at("compute_devices"), IsEmpty());
  for (const Json& result : results.at("cases")) {
    const bool on_device = result.at("algorithm") == "gpu-sap";
    EXPECT_EQ(result.at("status"), on_device ? "unsupported" : "ok");
    if (on_device) {
      EXPECT_THAT(result.at("reason"), HasSubstr("OpenCL"));
    }
  }
}

TEST_F(Device, WithoutAPlaceForPoclsKernelsEverythingElseRuns) {
  for (const ComputeDevice& device : computeDevices()) {
    if (device.platform != "Portable Computing Language") GTEST_SKIP() << "there are other devices";
  }
  const ProgramResult ended =
      run(short_run_, {.environment = {{"POCL_CACHE_DIR", "/proc/nonexistent"}}});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const Json results = readJson(file("r.json"));
  for (const Json& result : results.at("cases")) {
    const bool on_device = result.at("algorithm") == "gpu-sap";
    EXPECT_EQ(result.at("status"), on_device ? "unsupported" : "ok");
    if (on_device) {
      EXPECT_THAT(result.at("reason"), HasSubstr("cache"));
    }
  }
}

// Building these kernels causes warnings, but their count must not be printed.
TEST_F(Device, KernelsAreBuiltInSilence) {
  const ProgramResult ended = run({"--headless", "brownian", "--objects", "50", "--frames", "1",
                                   "--algorithm", "b3-sap,gpu-sap,gpu-grid", "--quiet"},
                                  {.environment = {{"POCL_CACHE_DIR", file("kernels").string()}}});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
}

TEST_F(Device, MemoryIsMeasured) {
  EXPECT_EQ(run(short_run_).status, 0);
  const Json results = readJson(file("r.json"));
  for (const Json& result : results.at("cases")) {
    EXPECT_TRUE(result.at("peak_bytes").is_number_unsigned()) << result.at("id");
  }
}

TEST_F(Device, TransfersAreInTheResults) {
  EXPECT_EQ(run(short_run_).status, 0);
  const Json results = readJson(file("r.json"));
  for (const Json& result : results.at("cases")) {
    const bool on_device = result.at("algorithm") == "gpu-sap";
    EXPECT_EQ(result.at("frames").contains("upload"), on_device);
    EXPECT_EQ(result.at("frames").contains("download"), on_device);
  }
}

}  // namespace
}  // namespace broadmark::tests
