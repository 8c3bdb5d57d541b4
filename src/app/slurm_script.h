// The jobs of a render for Slurm.
#ifndef SHEAF_APP_SLURM_SCRIPT_H_
#define SHEAF_APP_SLURM_SCRIPT_H_

#include <string>
#include <vector>

#include "sheaf/error.h"
#include "src/app/part_commands.h"

namespace sheaf {

// kUsage where one of `options`, which go to sbatch as they are, is one that the script sets.
Status CheckSbatchOptions(const std::vector<std::string>& options);

// A script for sh that gives sbatch an array job of the parts, and a job that joins them and waits
// for all of them.
std::string SlurmScript(const PartPlan& plan, const std::vector<std::string>& options);

// Runs such a script. kInputOutput where there is no sbatch, or it refuses the jobs.
Status RunSlurmScript(const std::string& script);

}  // namespace sheaf

#endif  // SHEAF_APP_SLURM_SCRIPT_H_
