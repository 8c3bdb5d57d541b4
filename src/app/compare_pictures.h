// How far pictures are apart.
#ifndef SHEAF_APP_COMPARE_PICTURES_H_
#define SHEAF_APP_COMPARE_PICTURES_H_

#include "sheaf/error.h"
#include "src/app/compare_request.h"
#include "src/app/exit_code.h"

namespace sheaf {

// The name of a metric, as --fail has it.
bool IsMetric(const std::string& name);

// Compares each picture of `request` with the first and prints the metrics. kOk where all keep the
// limits, else kDifferent.
Result<ExitCode> ComparePictures(const CompareRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_COMPARE_PICTURES_H_
