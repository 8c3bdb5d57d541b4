#include "src/app/commands.h"

#include "src/app/bench_command.h"
#include "src/app/check_command.h"
#include "src/app/compare_command.h"
#include "src/app/convert_command.h"
#include "src/app/denoise_command.h"
#include "src/app/diff_command.h"
#include "src/app/info_command.h"
#include "src/app/manual_command.h"
#include "src/app/merge_command.h"
#include "src/app/pareto_command.h"
#include "src/app/render_command.h"
#include "src/app/stress_command.h"
#include "src/app/submit_command.h"
#include "src/app/view_command.h"

namespace sheaf {
namespace {

constexpr CommandEntry kCommands[] = {
    {"render", "Render a scene into pictures",
     "  sheaf render scene.json -o picture.png\n"
     "  sheaf render scene.json --views seven -o 'out/{camera}.png'\n"
     "  sheaf render scene.json --camera front --size 1280x960 --json -o front.pfm\n"
     "  sheaf render model.glb -o model.exr --aov depth,normal\n"
     "  sheaf render scene.json --tile 2/8 -o part2.png\n",
     &RenderCommand},
    {"view", "Show a scene in a window, to move about in it", "  sheaf view scene.json\n",
     &ViewCommand},
    {"merge", "Join what --tile I/N or --crop rendered into the whole picture",
     "  sheaf merge part1.png part2.png ... -o whole.png\n", &MergeCommand},
    {"submit", "Render on many machines: jobs for Slurm, or a list of commands",
     "  sheaf submit scene.json -o picture.exr --parts 64 --sbatch=--time=2:00:00 --run\n"
     "  sheaf submit scene.json -o picture.png --parts 8 --list | parallel\n",
     &SubmitCommand},
    {"convert", "Turn a scene or model into scene JSON, or a picture into another format",
     "  sheaf convert scene.nff -o scene.json\n", &ConvertCommand},
    {"denoise", "Filter the noise out of a picture, guided by its layers",
     "  sheaf denoise noisy.exr --transfer srgb -o picture.png\n"
     "  sheaf denoise noisy.pfm --albedo a.pfm --normal n.pfm --depth d.pfm -o picture.pfm\n",
     &DenoiseCommand},
    {"check", "Validate scenes and say what rendering them would skip",
     "  sheaf check scene.json\n", &CheckCommand},
    {"compare", "Compare targets and threads on a scene bit by bit, or pictures by metrics",
     "  sheaf compare scene.json --targets all --threads 1,2\n"
     "  sheaf compare expected.png found.png --fail psnr=40\n",
     &CompareCommand},
    {"diff", "Show where two pictures differ, as a picture",
     "  sheaf diff expected.png found.png -o where.png\n", &DiffCommand},
    {"bench", "Time a scene on every SIMD target",
     "  sheaf bench scene.json --baseline before.json\n", &BenchCommand},
    {"pareto", "Chart run time against error over a scene's settings",
     "  sheaf pareto scene.json -o report/\n", &ParetoCommand},
    {"stress", "Run the stress cases of the numerics", "  sheaf stress\n", &StressCommand},
    {"info", "Show this build and its SIMD targets, or a scene", "  sheaf info scene.json\n",
     &InfoCommand},
    {"completion", "Print the completion of this command for a shell",
     "  sheaf completion bash > ~/.local/share/bash-completion/completions/sheaf\n",
     &CompletionCommand},
    {"man", "Print a man page", "  sheaf man render | man -l -\n", &ManCommand},
};

}  // namespace

std::span<const CommandEntry> Commands() { return kCommands; }

}  // namespace sheaf
