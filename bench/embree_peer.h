// Embree, given every advantage that its manual names: the widest instruction set of the processor,
// every call, both flags, both build qualities, denormals flushed, rays already in its own layout.
#ifndef SHEAF_BENCH_EMBREE_PEER_H_
#define SHEAF_BENCH_EMBREE_PEER_H_

#include <embree3/rtcore.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/make_rays.h"
#include "bench/make_scenes.h"
#include "simd/query.h"
#include "src/core/aligned_array.h"

namespace sheaf::bench {

// The widest instruction set that Embree has for this processor, by Embree's name.
const char* EmbreeIsa();

class EmbreeDevice {
 public:
  // Ends the program where Embree refuses to run.
  explicit EmbreeDevice(int threads, const std::string& isa = EmbreeIsa());
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const { return device_; }
  // What Embree has allocated on this device and not freed.
  std::ptrdiff_t bytes_held() const { return bytes_held_; }

 private:
  RTCDevice device_;
  std::atomic<std::ptrdiff_t> bytes_held_ = 0;
};

// Shares the arrays of `scene`, so that Embree holds nothing but its tree; `scene` must outlive it.
class EmbreeScene {
 public:
  EmbreeScene(const EmbreeDevice& device, const BenchScene& scene, RTCBuildQuality quality,
              RTCSceneFlags flags = RTC_SCENE_FLAG_NONE);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  // Builds the tree. To be called once, before any ray.
  void Commit() { rtcCommitScene(scene_); }

  RTCScene get() const { return scene_; }

 private:
  std::vector<float> padded_vertices_;  // Embree reads 16 bytes at every vertex
  RTCScene scene_;
};

// The ways to hand rays to Embree. kNM: 16 packets of 16 a call; k1M: all rays in one call.
enum class EmbreeCall { k1, k8, k16, k1M, kNM };
inline constexpr EmbreeCall kEmbreeCalls[] = {EmbreeCall::k1, EmbreeCall::k8, EmbreeCall::k16,
                                              EmbreeCall::k1M, EmbreeCall::kNM};

const char* NameOf(EmbreeCall call);
// Rays a record of the layout that a call reads.
std::uint32_t WidthOf(EmbreeCall call);

// Rays in the layout of the calls of one width.
class EmbreeRays {
 public:
  EmbreeRays(const RayBatch& batch, Query query, std::uint32_t width);

  // Makes the rays new: a trace leaves its hits in them.
  void Reset();
  // One trace of all rays, nothing else. `call` has the width of these rays.
  void Trace(RTCScene scene, EmbreeCall call, RTCIntersectContextFlags flags);

  // Results of ray i after a trace. The primitive is numbered as in BenchScene, kNoPrimitive where
  // nothing was hit.
  float t(std::uint32_t i) const { return Word(kFarField, i); }
  std::uint32_t Primitive(std::uint32_t i, const BenchScene& scene) const;
  bool IsOccluded(std::uint32_t i) const { return t(i) < 0; }

 private:
  // A record of width N is one array of N words a field: RTCRayN, then RTCHitN for kClosest.
  static constexpr std::uint32_t kFarField = 8, kRayFields = 12, kPrimitiveField = 17,
                                 kGeometryField = 18, kFields = 20;

  float& Word(std::uint32_t field, std::uint32_t i) {
    return words_[(std::size_t{i / width_} * fields_ + field) * width_ + i % width_];
  }
  const float& Word(std::uint32_t field, std::uint32_t i) const {
    return const_cast<EmbreeRays*>(this)->Word(field, i);
  }

  Query query_;
  std::uint32_t width_, fields_, count_, records_;
  AlignedArray<float> words_;
  AlignedArray<float> t_max_;
  AlignedArray<std::int32_t> last_valid_;  // lanes of the last record
};

// Within its scope denormals are flushed, as Embree's manual asks; Sheaf needs them kept.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  std::uint32_t saved_ = 0;
};

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_EMBREE_PEER_H_
