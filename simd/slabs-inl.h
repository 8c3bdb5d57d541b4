// A single ray as box tests see it: in lanes of its own number, or in double where that has not the
// range.
#if defined(SHEAF_SIMD_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_SLABS_INL_H_
#undef SHEAF_SIMD_SLABS_INL_H_
#else
#define SHEAF_SIMD_SLABS_INL_H_
#endif

#include <cmath>

#include "simd/leaf-inl.h"
#include "simd/packet-inl.h"
#include "simd/tree.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// A node's planes are float; lanes of Real hold them exactly.
template <class D>
HWY_INLINE hn::Vec<D> LoadPlanes(D d, const float* planes) {
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    return hn::Load(d, planes);
  } else {
    return hn::PromoteTo(d, hn::Load(hn::Rebind<float, D>(), planes));
  }
}

// Rows of TreeNode::bounds where rays of an octant enter and leave boxes.
struct SlabRows {
  std::size_t in_x, in_y, in_z, out_x, out_y, out_z;

  explicit HWY_INLINE SlabRows(std::uint32_t octant)
      : in_x(octant & 1 ? 3 : 0),
        in_y(octant & 2 ? 4 : 1),
        in_z(octant & 4 ? 5 : 2),
        out_x(3 - in_x),
        out_y(5 - in_y),
        out_z(7 - in_z) {}
};

// One ray of a packet that PrepareBoxes holds for.
template <typename Real>
struct LaneSlabs {
  using Distance = Real;
  using D = LeafLanes<Real>;
  using V = hn::Vec<D>;

  SlabRows rows;
  V scale_x, scale_y, scale_z, enter_x, enter_y, enter_z, leave_x, leave_y, leave_z, t_min;

  HWY_INLINE LaneSlabs(const TreeView<Real>& /*tree*/, const Packet<Real>& packet,
                       std::uint32_t lane)
      : rows(packet.octant[lane]) {
    const auto all = [&](const Real(&values)[kPacketSize<Real>])
                         SHEAF_LAMBDA { return hn::Set(D(), values[lane]); };
    scale_x = all(packet.scale[0]), scale_y = all(packet.scale[1]), scale_z = all(packet.scale[2]);
    enter_x = all(packet.enter[0]), enter_y = all(packet.enter[1]), enter_z = all(packet.enter[2]);
    leave_x = all(packet.leave[0]), leave_y = all(packet.leave[1]), leave_z = all(packet.leave[2]);
    t_min = all(packet.t_min);
  }

  static HWY_INLINE Real LastOf(Real t_best) { return t_best * Real(kBoxFarFactor); }

  // Bits of the children from i on, a vector of them, that the ray meets up to `last`. Writes where
  // it enters them.
  HWY_INLINE std::uint32_t Meet(const TreeNode& node, std::uint32_t i, Real last,
                                Real* enters) const {
    const D d;
    const auto plane = [&](std::size_t row)
                           SHEAF_LAMBDA { return LoadPlanes(d, node.bounds[row] + i); };
    const V enter = hn::Max(hn::Max(hn::MulAdd(plane(rows.in_x), scale_x, enter_x),
                                    hn::MulAdd(plane(rows.in_y), scale_y, enter_y)),
                            hn::Max(hn::MulAdd(plane(rows.in_z), scale_z, enter_z), t_min));
    const V leave = hn::Mul(hn::Min(hn::Min(hn::MulAdd(plane(rows.out_x), scale_x, leave_x),
                                            hn::MulAdd(plane(rows.out_y), scale_y, leave_y)),
                                    hn::MulAdd(plane(rows.out_z), scale_z, leave_z)),
                            hn::Set(d, Real(kBoxFarFactor)));
    hn::Store(enter, d, enters + i);
    return MaskBits(d, hn::Le(enter, hn::Min(leave, hn::Set(d, last))));
  }
};

// One ray of a packet within the wider limits: WideSlabsOf of src/scalar/ray_slabs.h.
template <typename Real>
struct WideSlabs {
  using Distance = double;
  using D = LeafLanes<double>;
  using V = hn::Vec<D>;

  SlabRows rows;
  double scale[3], enter[3], leave[3], first;

  HWY_INLINE WideSlabs(const TreeView<Real>& tree, const Packet<Real>& packet, std::uint32_t lane)
      : rows(packet.octant[lane]), first(OutwardBy(static_cast<double>(packet.t_min[lane]), -1)) {
    double size = 0, reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double o = static_cast<double>(packet.origin[axis][lane]);
      size = std::max(size, std::abs(static_cast<double>(packet.direction[axis][lane])));
      reach = std::max({reach, static_cast<double>(tree.upper[axis]) - o,
                        o - static_cast<double>(tree.lower[axis])});
    }
    const double least = size * static_cast<double>(kMinBoxSlope);
    for (int axis = 0; axis < 3; ++axis) {
      const double o = static_cast<double>(packet.origin[axis][lane]);
      const double dir = static_cast<double>(packet.direction[axis][lane]);
      const bool steep = std::abs(dir) < least;
      double slack = std::abs(o) * static_cast<double>(kBoxOriginSlack) +
                     static_cast<double>(kBoxAbsoluteSlack);
      if (steep) slack += reach * 2 * static_cast<double>(kMinBoxSlope);
      slack = std::copysign(slack, dir);
      scale[axis] = 1 / (steep ? std::copysign(least, dir) : dir);
      enter[axis] = -((o + slack) * scale[axis]);
      leave[axis] = -((o - slack) * scale[axis]);
    }
  }

  static HWY_INLINE double OutwardBy(double t, double sign) {
    return t + sign * std::abs(t) * (static_cast<double>(kBoxFarFactor) - 1);
  }
  static HWY_INLINE double LastOf(Real t_best) { return OutwardBy(static_cast<double>(t_best), 1); }

  // As LaneSlabs::Meet.
  HWY_INLINE std::uint32_t Meet(const TreeNode& node, std::uint32_t i, double last,
                                double* enters) const {
    const D d;
    const auto at = [&](std::size_t row, int axis, const double* offset) SHEAF_LAMBDA {
      return hn::MulAdd(LoadPlanes(d, node.bounds[row] + i), hn::Set(d, scale[axis]),
                        hn::Set(d, offset[axis]));
    };
    const V margin = hn::Set(d, static_cast<double>(kBoxFarFactor) - 1);
    const V in =
        hn::Max(hn::Max(at(rows.in_x, 0, enter), at(rows.in_y, 1, enter)), at(rows.in_z, 2, enter));
    const V out = hn::Min(hn::Min(at(rows.out_x, 0, leave), at(rows.out_y, 1, leave)),
                          at(rows.out_z, 2, leave));
    const V from = hn::Max(hn::NegMulAdd(hn::Abs(in), margin, in), hn::Set(d, first));
    hn::Store(from, d, enters + i);
    return MaskBits(d,
                    hn::Le(from, hn::Min(hn::MulAdd(hn::Abs(out), margin, out), hn::Set(d, last))));
  }
};

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_SLABS_INL_H_
