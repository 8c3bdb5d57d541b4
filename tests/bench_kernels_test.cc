// `sheaf bench --kernels`, and what it calls.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sheaf/target.h"
#include "src/lab/kernel_cases.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

using nlohmann::json;

TEST_CASE("bench --kernels has every kernel on every target") {
  const Workspace work;
  const Outcome text = work.Run({"bench", "--kernels", "--repetitions", "1", "--targets", "auto",
                                 "--json=" + (work / "k.json"), "--progress", "none"});
  CAPTURE(text.err);
  REQUIRE(text.code == 0);
  CHECK(Contains(text.out, "lanes in use"));
  CHECK(Contains(text.out, "spawn, glass"));
  CHECK(!Contains(text.out, "scalar      "));  // there was no baseline
  const json alone = json::parse(ReadText(work / "k.json"));
  CHECK(alone["kernels"].size() + 1 == LineCount(text.out));
  CHECK(!alone["kernels"][0]["targets"][0].contains("over_scalar"));

  const Outcome all = work.Run({"bench", "--kernels", "--repetitions", "2", "--json"});
  REQUIRE(all.code == 0);
  const json report = json::parse(all.out);
  for (const char* key : {"sheaf", "date", "processor", "cores", "affinity", "compiler", "flags",
                          "build_type", "load"}) {
    CHECK_MESSAGE(report.contains(key), std::string(key));
  }
  CHECK(report["kernels"].size() >= 14);
  for (const json& kernel : report["kernels"]) {
    CAPTURE(kernel["kernel"].get<std::string>());
    REQUIRE(kernel["targets"].size() == UsableTargets().size() + 1);
    for (const json& target : kernel["targets"]) {
      const double lanes = target["lanes"], in_use = target["lanes_in_use"];
      CHECK(in_use > 0);
      CHECK(in_use <= lanes);
      CHECK(target["nanoseconds"]["repetitions"].size() == 2);
      CHECK(target["nanoseconds"]["low"].get<double>() > 0);
      CHECK(target["over_scalar"].get<double>() > 0);
    }
    CHECK(kernel["targets"][0]["target"] == "scalar");
    CHECK(kernel["targets"][0]["over_scalar"] == 1.0);
  }
}

TEST_CASE("bench --kernels takes no scene, and bench without it needs one") {
  const Workspace work;
  const auto refused = [&](const std::vector<std::string>& command, const std::string& part) {
    const Outcome outcome = work.Run(command);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(LineCount(outcome.err) == 1);
    CHECK(Contains(outcome.err, part));
  };
  refused({"bench"}, "SCENE is required, or --kernels");
  refused({"bench", "--kernels", kScene}, "SCENE: not with --kernels");
  refused({"bench", "--kernels", "--spp", "2"}, "--spp: not with --kernels");
  refused({"bench", "--kernels", "--baseline", "x"}, "--baseline: not with --kernels");
  refused({"bench", "--kernels", "--targets", "avx9"}, "--targets");
}

TEST_CASE("kernels are measured at work: rays hit, some lanes idle, elements fill vectors") {
  for (const KernelCase& work : MakeKernelCases()) {
    CAPTURE(work.name);
    CHECK(work.elements > 16 * 16);
    CHECK(work.live > 0.2);
    CHECK(work.live <= 1);
    const bool depends_on_light =
        work.name == "face" || work.name == "compact" || work.name.starts_with("shade");
    CHECK((work.live < 0.95) == depends_on_light);
    work.scalar();
    work.simd(StrictKernels<float>(0));
  }
}

}  // namespace
}  // namespace sheaf
