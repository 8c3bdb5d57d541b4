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

  template <typename TreeReal>
  HWY_INLINE LaneSlabs(const TreeView<TreeReal>& /*tree*/, const Packet<Real>& packet,
                       std::uint32_t lane)
      : rows(packet.octant[lane]) {
    const auto all = [&](const Real(&values)[kPacketSize<Real>])
                         SHEAF_LAMBDA { return hn::Set(D(), values[lane]); };
    scale_x = all(packet.scale[0]), scale_y = all(packet.scale[1]), scale_z = all(packet.scale[2]);
    enter_x = all(packet.enter[0]), enter_y = all(packet.enter[1]), enter_z = all(packet.enter[2]);
    leave_x = all(packet.leave[0]), leave_y = all(packet.leave[1]), leave_z = all(packet.leave[2]);
    t_min = all(packet.t_min);
  }

  // Where the ray enters, `least` or later, and leaves the boxes of the children from i on, a
  // vector of them.
  HWY_INLINE V Enter(const TreeNode& node, std::uint32_t i, V least) const {
    return hn::Max(hn::Max(hn::MulAdd(Planes(node, rows.in_x, i), scale_x, enter_x),
                           hn::MulAdd(Planes(node, rows.in_y, i), scale_y, enter_y)),
                   hn::Max(hn::MulAdd(Planes(node, rows.in_z, i), scale_z, enter_z), least));
  }
  HWY_INLINE V Leave(const TreeNode& node, std::uint32_t i) const {
    return hn::Min(hn::Min(hn::MulAdd(Planes(node, rows.out_x, i), scale_x, leave_x),
                           hn::MulAdd(Planes(node, rows.out_y, i), scale_y, leave_y)),
                   hn::MulAdd(Planes(node, rows.out_z, i), scale_z, leave_z));
  }

  static HWY_INLINE Real LastOf(Real t_best) { return t_best * Real(kBoxFarFactor); }

  // Bits of those children that the ray meets up to `last`. Writes where it enters them.
  HWY_INLINE std::uint32_t Meet(const TreeNode& node, std::uint32_t i, Real last,
                                Real* enters) const {
    const D d;
    const V enter = Enter(node, i, t_min);
    const V leave = hn::Mul(Leave(node, i), hn::Set(d, Real(kBoxFarFactor)));
    hn::Store(enter, d, enters + i);
    return MaskBits(d, hn::Le(enter, hn::Min(leave, hn::Set(d, last))));
  }

 private:
  static HWY_INLINE V Planes(const TreeNode& node, std::size_t row, std::uint32_t i) {
    return LoadPlanes(D(), node.bounds[row] + i);
  }
};

// One ray of a packet within the wider limits, in double and for any t: WideSlabsOf of
// src/scalar/ray_slabs.h.
template <typename Real>
struct WideSlabs {
  using Distance = double;
  using D = LeafLanes<double>;
  using V = hn::Vec<D>;

  LaneSlabs<double> slabs;
  double first;

  HWY_INLINE WideSlabs(const TreeView<Real>& tree, const Packet<Real>& packet, std::uint32_t lane)
      : slabs(tree, Widened(tree, packet, lane), 0),
        first(OutwardBy(static_cast<double>(packet.t_min[lane]), -1)) {}

  static HWY_INLINE double OutwardBy(double t, double sign) {
    return t + sign * std::abs(t) * (static_cast<double>(kBoxFarFactor) - 1);
  }
  static HWY_INLINE double LastOf(Real t_best) { return OutwardBy(static_cast<double>(t_best), 1); }

  // As LaneSlabs::Meet.
  HWY_INLINE std::uint32_t Meet(const TreeNode& node, std::uint32_t i, double last,
                                double* enters) const {
    const D d;
    const V margin = hn::Set(d, static_cast<double>(kBoxFarFactor) - 1);
    const V in = slabs.Enter(node, i, hn::Set(d, -kDefaultTMax<double>));
    const V out = slabs.Leave(node, i);
    const V from = hn::Max(hn::NegMulAdd(hn::Abs(in), margin, in), hn::Set(d, first));
    hn::Store(from, d, enters + i);
    return MaskBits(d,
                    hn::Le(from, hn::Min(hn::MulAdd(hn::Abs(out), margin, out), hn::Set(d, last))));
  }

 private:
  // A packet of the ray in every lane.
  static HWY_NOINLINE Packet<double> Widened(const TreeView<Real>& tree, const Packet<Real>& packet,
                                             std::uint32_t lane) {
    const Lanes<double> d;
    Packet<double> wide;
    for (int axis = 0; axis < 3; ++axis) {
      hn::Store(hn::Set(d, static_cast<double>(packet.origin[axis][lane])), d, wide.origin[axis]);
      hn::Store(hn::Set(d, static_cast<double>(packet.direction[axis][lane])), d,
                wide.direction[axis]);
    }
    hn::Store(hn::Set(d, static_cast<double>(packet.t_min[lane])), d, wide.t_min);
    hn::Store(hn::Set(d, kDefaultTMax<double>), d, wide.t_best);
    wide.has_boxes = false;
    PrepareBoxes(tree, wide);
    return wide;
  }
};

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_SLABS_INL_H_
