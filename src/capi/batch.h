// Rays, options and hits of C as the C++ library takes them.
#ifndef SHEAF_CAPI_BATCH_H_
#define SHEAF_CAPI_BATCH_H_

#include <cstddef>

#include "sheaf/capi.h"
#include "sheaf/error.h"
#include "sheaf/geometry.h"
#include "src/capi/handles.h"

namespace sheaf::capi {

template <typename Real>
struct BatchOf {
  RayArraysOf<Real> rays;
  std::size_t count = 0;
  TraceOptionsOf<Real> options;
};
using Batch = BatchOf<float>;

// These fail with a message that names the structure that is missing or does not fit.

Result<BatchOf<float>> TakeRays(const sheaf_rays* given);
Result<BatchOf<double>> TakeRays(const sheaf_rays_d* given);

// `options` may be null.
Result<BatchOf<float>> TakeBatch(const sheaf_rays* rays, const sheaf_trace_options* options);
Result<BatchOf<double>> TakeBatch(const sheaf_rays_d* rays, const sheaf_trace_options_d* options);

Result<HitArrays> TakeHits(const sheaf_hits* given);
Result<HitArraysD> TakeHits(const sheaf_hits_d* given);

}  // namespace sheaf::capi

#endif  // SHEAF_CAPI_BATCH_H_
