#include "src/app/bench_request.h"

#include "src/app/add_options.h"

namespace sheaf {

void AddBenchOptions(CLI::App& app, BenchRequest& request) {
  request.command = &app;
  AddInput(app, "SCENE", request.scene, Presence::kOptional,
           "The scene file (needed without --kernels)");
  AddFlag(app, "--kernels", request.kernels,
          "Measure each kernel on each target instead of a scene's frames");
  AddSceneOptions(app, request.options);
  AddMomentOptions(app, request.options);
  AddName(app, "--camera", request.camera, "NAME", "The camera; the scene's first if absent");
  AddSize(app, request.size);
  AddInteger(app, "--spp", request.samples, 1, kMaxSamples, "Samples a pixel");
  AddTargets(app, request.targets, "What renders; all: every usable one and scalar");
  AddThreads(app, request.threads);
  AddInteger(app, "--repetitions", request.repetitions, 1, 1000,
             "Frames of each row, taken in turn; 9 if absent, from 6 with a 95 % interval");
  AddPath(app, "--baseline", request.baseline, "FILE",
          "A file that --json wrote, to judge against");
  AddFlag(app, "--absolute", request.absolute,
          "Judge seconds alone, not also in times of the machine's own speed");
  AddFlag(app, "--force", request.force, "Judge against a run on another processor or build too");
  AddChoice(app, "--progress", request.progress, {"auto", "plain", "none"},
            "What stderr shows meanwhile");
  AddJson(app, request.json, "The result as JSON to stdout, or into FILE");
}

}  // namespace sheaf
