// Whether a scene has the same bits on every target and number of threads.
#ifndef SHEAF_APP_COMPARE_RENDERINGS_H_
#define SHEAF_APP_COMPARE_RENDERINGS_H_

#include "sheaf/error.h"
#include "src/app/compare_request.h"
#include "src/app/exit_code.h"

namespace sheaf {

// Renders the one scene of `request` and prints what differs. kOk where no pixel differs by more
// than is allowed, else kDifferent.
Result<ExitCode> CompareRenderings(const CompareRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_COMPARE_RENDERINGS_H_
