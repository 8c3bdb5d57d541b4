// Traces several lanes through the tree together. A lane is a ray (in a packet) or a packet (in a
// frustum or sheet). A node takes two tests: first the whole beam against all eight children, then
// each child that it may meet against the lanes.
#if defined(SHEAF_SIMD_TRACE_BEAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_TRACE_BEAM_INL_H_
#undef SHEAF_SIMD_TRACE_BEAM_INL_H_
#else
#define SHEAF_SIMD_TRACE_BEAM_INL_H_
#endif

#include "simd/streams.h"
#include "simd/trace_ray-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// A lane enters a box at the maximum over the axes of plane * enter_scale + enter, and leaves it at
// the minimum of plane * leave_scale + leave. All lanes share the octant. The beam as a whole
// enters no earlier than (plane - all_enter) * all_enter_scale and leaves no later than the same
// with `all_leave`.
template <typename Real>
struct alignas(kAlignment) Beam {
  static constexpr std::uint32_t kSize = kPacketSize<Real>;
  Real enter_scale[3][kSize], enter[3][kSize];
  Real leave_scale[3][kSize], leave[3][kSize];
  Real t_min[kSize];
  Real t_last[kSize];  // t_best times kBoxFarFactor; kDone: not in the beam
  Real all_enter[3], all_enter_scale[3], all_leave[3], all_leave_scale[3];
  Real all_t_min;
  std::uint32_t octant;
};

// Which of several boxes, one a lane, the beam may meet up to t_last. Takes the planes where it
// enters and leaves the boxes. A plane behind the beam gives a negative number with any scale.
template <class D, class V, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Mask<D> BeamMeets(D d, const Beam<Real>& beam, V in_x, V in_y, V in_z, V out_x,
                                 V out_y, V out_z, V t_last) {
  const auto enter_at = [&](V plane, int axis) SHEAF_LAMBDA {
    return hn::Mul(hn::Sub(plane, hn::Set(d, beam.all_enter[axis])),
                   hn::Set(d, beam.all_enter_scale[axis]));
  };
  const auto leave_at = [&](V plane, int axis) SHEAF_LAMBDA {
    return hn::Mul(hn::Sub(plane, hn::Set(d, beam.all_leave[axis])),
                   hn::Set(d, beam.all_leave_scale[axis]));
  };
  const V enter = hn::Max(hn::Max(enter_at(in_x, 0), enter_at(in_y, 1)),
                          hn::Max(enter_at(in_z, 2), hn::Set(d, beam.all_t_min)));
  const V leave =
      hn::Mul(hn::Min(hn::Min(leave_at(out_x, 0), leave_at(out_y, 1)), leave_at(out_z, 2)),
              hn::Set(d, Real(kBoxFarFactor)));
  return hn::Le(enter, hn::Min(leave, t_last));
}

// Children to visit, the nearest on top, and where the lanes enter them. A packet that leaves a
// frustum or sheet goes on above what that has left to do: together they are no deeper than the
// tree.
template <typename Real>
struct alignas(kAlignment) BeamStack {
  static constexpr std::uint32_t kCapacity = kTreeStackSize + 1;
  Real enter[kCapacity][kPacketSize<Real>];
  std::uint32_t child[kCapacity];
  std::uint32_t size = 0;
};

// What a visitor answers for a child that some lanes may meet: it is done with it, or the child's
// own children are to be visited.
enum class Visit { kDone, kDescend };

// Calls visit(child, lanes) for each child that `lanes` (a mask, never empty) may meet, front to
// back, beginning with `start`. The visitor may lower t_last of the lanes.
template <typename Real, class Visitor>
HWY_INLINE void TraceBeam(const TreeView<Real>& tree, BeamStack<Real>& stack, Beam<Real>& beam,
                          std::uint32_t start, Visitor visit) {
  const Lanes<Real> d;
  const LeafLanes<Real> d8;
  const std::uint32_t octant = beam.octant;
  std::uint32_t in[3], out[3];
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const bool backward = octant >> axis & 1;
    in[axis] = backward ? axis + 3 : axis;
    out[axis] = backward ? axis : axis + 3;
  }
  const auto far_factor = hn::Set(d, Real(kBoxFarFactor));

  const std::uint32_t bottom = stack.size;
  std::uint32_t size = bottom + 1;
  hn::Store(hn::Load(d, beam.t_min), d, stack.enter[bottom]);
  stack.child[bottom] = start;
  while (size > bottom) {
    --size;
    const std::uint32_t child = stack.child[size];
    const auto t_last = hn::Load(d, beam.t_last);
    const auto lanes = hn::Le(hn::Load(d, stack.enter[size]), t_last);
    if (hn::AllFalse(d, lanes)) continue;
    stack.size = size;
    if (visit(child, lanes) == Visit::kDone) continue;

    const TreeNode& node = tree.nodes[child];
    const auto all_t_last = hn::Set(d8, hn::GetLane(hn::MaxOfLanes(d, t_last)));
    std::uint32_t met = 0;
    for (std::uint32_t i = 0; i < kTreeWidth; i += LaneCount(d8)) {
      const auto plane = [&](std::uint32_t row)
                             SHEAF_LAMBDA { return LoadPlanes(d8, node.bounds[row] + i); };
      met |= MaskBits(d8, BeamMeets(d8, beam, plane(in[0]), plane(in[1]), plane(in[2]),
                                    plane(out[0]), plane(out[1]), plane(out[2]), all_t_last))
             << i;
    }

    // Tests the children that are left against each lane. The nearest is pushed last.
    std::uint32_t order = node.order[octant];
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      const std::uint32_t i = order >> 28;
      order <<= 4;
      if ((met >> i & 1) == 0) continue;
      const auto enter_at = [&](int axis) SHEAF_LAMBDA {
        return hn::MulAdd(hn::Set(d, static_cast<Real>(node.bounds[in[axis]][i])),
                          hn::Load(d, beam.enter_scale[axis]), hn::Load(d, beam.enter[axis]));
      };
      const auto leave_at = [&](int axis) SHEAF_LAMBDA {
        return hn::MulAdd(hn::Set(d, static_cast<Real>(node.bounds[out[axis]][i])),
                          hn::Load(d, beam.leave_scale[axis]), hn::Load(d, beam.leave[axis]));
      };
      const auto enter =
          hn::Max(hn::Max(enter_at(0), enter_at(1)), hn::Max(enter_at(2), hn::Load(d, beam.t_min)));
      const auto leave =
          hn::Mul(hn::Min(hn::Min(leave_at(0), leave_at(1)), leave_at(2)), far_factor);
      const auto meets = hn::Le(enter, hn::Min(leave, t_last));
      if (hn::AllFalse(d, meets)) continue;
      hn::Store(hn::IfThenElse(meets, enter, hn::Inf(d)), d, stack.enter[size]);
      stack.child[size] = node.child[i];
      FetchAhead(tree, node.child[i]);
      ++size;
    }
  }
  stack.size = bottom;
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_TRACE_BEAM_INL_H_
