// Whether this process is one of several that mpirun, or its like, has started for one render.
#ifndef SHEAF_APP_JOIN_RANKS_H_
#define SHEAF_APP_JOIN_RANKS_H_

#include "sheaf/error.h"
#include "src/cluster/ranks.h"

namespace sheaf {

// Null where it stands alone. kUsage where it does not and Sheaf was built without MPI, or with
// another MPI than that which started it.
Result<Ranks*> FindRanks();

}  // namespace sheaf

#endif  // SHEAF_APP_JOIN_RANKS_H_
