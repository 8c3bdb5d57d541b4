#include "src/app/join_ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <string_view>

#include "src/app/choose.h"
#include "src/app/parse_options.h"
#include "src/core/build_info.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

// How many processes a launcher says that it has started; 0: there is none.
int LaunchedProcesses() {
  const auto count_in = [](const char* name) {
    const char* const text = std::getenv(name);
    return text == nullptr ? 0 : ParseInteger(text, 1, 1 << 24).value_or(0);
  };
  // Open MPI; MPICH, Intel MPI and srun --mpi=pmi2; MVAPICH2.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE"}) {
    if (const int count = count_in(name); count > 0) return count;
  }
  // srun --mpi=pmix names no size of its own.
  return std::getenv("PMIX_RANK") != nullptr ? count_in("SLURM_STEP_NUM_TASKS") : 0;
}

bool IsMpiBuiltIn() {
  for (const OptionalPart& part : OptionalParts()) {
    if (std::string_view(part.name) == "MPI") return part.is_built_in;
  }
  return false;
}

}  // namespace

Result<Ranks*> FindRanks() {
  const int launched = LaunchedProcesses();
  if (launched == 0) return nullptr;
  if (!IsMpiBuiltIn()) {
    // Alone it does the same without.
    if (launched == 1) return nullptr;
    return Usage(fmt::format("started as {} processes, but Sheaf was built without MPI", launched));
  }
  // Global: an MPI loads parts of itself that look for its names.
  void* const module = dlopen(kMpiModule, RTLD_NOW | RTLD_GLOBAL);
  void* const found = module != nullptr ? dlsym(module, kJoinRanks) : nullptr;
  if (found == nullptr) {
    return Usage(fmt::format("{} cannot be loaded: {}", kMpiModule, Printable(dlerror())));
  }
  std::string error;
  Ranks* const ranks = reinterpret_cast<JoinRanks*>(found)(error);
  if (ranks == nullptr) return Error{ErrorKind::kInputOutput, error};
  if (ranks->count() != launched) {
    return Usage(
        fmt::format("started as {} processes, and the MPI that Sheaf was built with sees "
                    "{}: start it with that MPI's mpirun",
                    launched, ranks->count()));
  }
  return ranks;
}

}  // namespace sheaf
