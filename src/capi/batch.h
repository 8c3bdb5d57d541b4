// Rays, options and hits of C as the C++ library takes them.
#ifndef SHEAF_CAPI_BATCH_H_
#define SHEAF_CAPI_BATCH_H_

#include <cstddef>

#include "sheaf/capi.h"
#include "sheaf/error.h"
#include "sheaf/geometry.h"

namespace sheaf::capi {

struct Batch {
  RayArrays rays;
  std::size_t count = 0;
  TraceOptions options;
};

// These fail with a message that names the structure that is missing or does not fit.

Result<Batch> TakeRays(const sheaf_geometry* geometry, const sheaf_rays* given);

// `given` may be null.
Result<Batch> TakeBatch(const sheaf_geometry* geometry, const sheaf_rays* rays,
                        const sheaf_trace_options* given);

Result<HitArrays> TakeHits(const sheaf_hits* given);

}  // namespace sheaf::capi

#endif  // SHEAF_CAPI_BATCH_H_
