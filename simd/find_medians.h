// Medians of six numbers each.
#ifndef SHEAF_SIMD_FIND_MEDIANS_H_
#define SHEAF_SIMD_FIND_MEDIANS_H_

#include <cstddef>
#include <cstdint>

namespace sheaf {

// medians[i] becomes the median of numbers[i + k * step], k from 0 to 5, for i in [0, count). NaN
// is not allowed. `medians` may be `numbers`, else they do not overlap. Bits: as
// sheaf::scalar::MedianOfSix. Reads and writes PaddedCount(count) lanes of each.
template <typename Real>
using FindMediansKernel = void(const Real* numbers, std::ptrdiff_t step, std::uint32_t count,
                               Real* medians);

}  // namespace sheaf

#endif  // SHEAF_SIMD_FIND_MEDIANS_H_
