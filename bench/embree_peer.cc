#include "bench/embree_peer.h"

#include <fmt/format.h>

#include <bit>
#include <cstdlib>

#if defined(__x86_64__)
#include <xmmintrin.h>

#include "simd/streams.h"
#endif

namespace sheaf::bench {
namespace {

static_assert(sizeof(RTCRayHit) == 80 && sizeof(RTCRay) == 48);
static_assert(sizeof(RTCRayHit8) == 80 * 8 && sizeof(RTCRay8) == 48 * 8);
static_assert(sizeof(RTCRayHit16) == 80 * 16 && sizeof(RTCRay16) == 48 * 16);

constexpr std::uint32_t kPacketsPerCall = 16;  // of kNM

void ReportError(void*, RTCError code, const char* text) {
  fmt::print(stderr, "Embree: error {}: {}\n", static_cast<int>(code), text);
  std::exit(EXIT_FAILURE);
}

bool CountBytes(void* held, ssize_t bytes, bool) {
  *static_cast<std::atomic<std::ptrdiff_t>*>(held) += bytes;
  return true;
}

}  // namespace

const char* EmbreeIsa() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512cd")) {
    return "avx512";
  }
  if (__builtin_cpu_supports("avx2")) return "avx2";
  return "sse2";
#else
  return "neon";
#endif
}

EmbreeDevice::EmbreeDevice(int threads, const std::string& isa) {
  device_ = rtcNewDevice(fmt::format("threads={},isa={}", threads, isa).c_str());
  if (device_ == nullptr) ReportError(nullptr, rtcGetDeviceError(nullptr), "no device");
  rtcSetDeviceErrorFunction(device_, ReportError, nullptr);
  rtcSetDeviceMemoryMonitorFunction(device_, CountBytes, &bytes_held_);
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(device_); }

EmbreeScene::EmbreeScene(const EmbreeDevice& device, const BenchScene& scene,
                         RTCBuildQuality quality, RTCSceneFlags flags)
    : scene_(rtcNewScene(device.get())) {
  rtcSetSceneBuildQuality(scene_, quality);
  rtcSetSceneFlags(scene_, flags);
  auto attach = [&](RTCGeometryType type, std::uint32_t id, auto set_buffers) {
    RTCGeometry geometry = rtcNewGeometry(device.get(), type);
    rtcSetGeometryBuildQuality(geometry, quality);
    set_buffers(geometry);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, id);
    rtcReleaseGeometry(geometry);
  };
  // The numbers of the geometries: EmbreeRays::Primitive.
  if (scene.triangle_count() > 0) {
    padded_vertices_ = scene.vertices;
    padded_vertices_.push_back(0);
    attach(RTC_GEOMETRY_TYPE_TRIANGLE, 0, [&](RTCGeometry geometry) {
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                 padded_vertices_.data(), 0, 3 * sizeof(float),
                                 scene.vertices.size() / 3);
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                 scene.indices.data(), 0, 3 * sizeof(std::uint32_t),
                                 scene.triangle_count());
    });
  }
  if (scene.sphere_count() > 0) {
    attach(RTC_GEOMETRY_TYPE_SPHERE_POINT, 1, [&](RTCGeometry geometry) {
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                 scene.spheres.data(), 0, 4 * sizeof(float), scene.sphere_count());
    });
  }
}

EmbreeScene::~EmbreeScene() { rtcReleaseScene(scene_); }

const char* NameOf(EmbreeCall call) {
  switch (call) {
    case EmbreeCall::k1:
      return "1";
    case EmbreeCall::k8:
      return "8";
    case EmbreeCall::k16:
      return "16";
    case EmbreeCall::k1M:
      return "1M";
    case EmbreeCall::kNM:
      return "NM";
  }
  return "";
}

std::uint32_t WidthOf(EmbreeCall call) {
  switch (call) {
    case EmbreeCall::k1:
    case EmbreeCall::k1M:
      return 1;
    case EmbreeCall::k8:
      return 8;
    case EmbreeCall::k16:
    case EmbreeCall::kNM:
      return 16;
  }
  return 0;
}

EmbreeRays::EmbreeRays(const RayBatch& batch, Query query, std::uint32_t width)
    : query_(query),
      width_(width),
      fields_(query == Query::kClosest ? kFields : kRayFields),
      count_(batch.count),
      records_((batch.count + width - 1) / width) {
  const std::uint32_t padded = records_ * width_;
  words_.Allocate(std::size_t{padded} * fields_);
  t_max_.Allocate(padded);
  last_valid_.Allocate(width_);
  const RayView<float> rays = batch.view();
  const float* const fields[8] = {rays.origin_x,    rays.origin_y,    rays.origin_z,    nullptr,
                                  rays.direction_x, rays.direction_y, rays.direction_z, nullptr};
  constexpr std::uint32_t kNearField = 3, kMaskField = 9;
  for (std::uint32_t i = 0; i < padded; ++i) {
    const bool is_ray = i < count_;
    for (std::uint32_t field = 0; field < 8; ++field) {
      if (is_ray && fields[field] != nullptr) Word(field, i) = fields[field][i];
    }
    Word(kNearField, i) = batch.intervals.all_t_min;
    Word(kMaskField, i) = std::bit_cast<float>(0xffffffffu);
    // An interval that is empty tells Embree that there is no ray.
    t_max_[i] = is_ray ? batch.intervals.all_t_max : -1.0f;
    if (i + width_ >= padded) last_valid_[i % width_] = is_ray ? -1 : 0;
  }
}

void EmbreeRays::Reset() {
  for (std::uint32_t i = 0; i < records_ * width_; ++i) {
    Word(kFarField, i) = t_max_[i];
    if (query_ == Query::kClosest) {
      Word(kGeometryField, i) = std::bit_cast<float>(RTC_INVALID_GEOMETRY_ID);
    }
  }
}

void EmbreeRays::Trace(RTCScene scene, EmbreeCall call, RTCIntersectContextFlags flags) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = flags;
  alignas(kAlignment) static constexpr std::int32_t kAllValid[16] = {
      -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
  const std::size_t stride = std::size_t{fields_} * width_ * sizeof(float);
  char* const first = reinterpret_cast<char*>(words_.data());
  char* const last = first + (records_ - 1) * stride;
  char* const end = first + records_ * stride;
  auto valid = [&](const char* record) { return record == last ? last_valid_.data() : kAllValid; };
  const bool closest = query_ == Query::kClosest;
  switch (call) {
    case EmbreeCall::k1:
      for (char* p = first; p != end; p += stride) {
        if (closest) {
          rtcIntersect1(scene, &context, reinterpret_cast<RTCRayHit*>(p));
        } else {
          rtcOccluded1(scene, &context, reinterpret_cast<RTCRay*>(p));
        }
      }
      break;
    case EmbreeCall::k8:
      for (char* p = first; p != end; p += stride) {
        if (closest) {
          rtcIntersect8(valid(p), scene, &context, reinterpret_cast<RTCRayHit8*>(p));
        } else {
          rtcOccluded8(valid(p), scene, &context, reinterpret_cast<RTCRay8*>(p));
        }
      }
      break;
    case EmbreeCall::k16:
      for (char* p = first; p != end; p += stride) {
        if (closest) {
          rtcIntersect16(valid(p), scene, &context, reinterpret_cast<RTCRayHit16*>(p));
        } else {
          rtcOccluded16(valid(p), scene, &context, reinterpret_cast<RTCRay16*>(p));
        }
      }
      break;
    case EmbreeCall::k1M:
      if (closest) {
        rtcIntersect1M(scene, &context, reinterpret_cast<RTCRayHit*>(first), records_, stride);
      } else {
        rtcOccluded1M(scene, &context, reinterpret_cast<RTCRay*>(first), records_, stride);
      }
      break;
    case EmbreeCall::kNM:
      for (std::uint32_t record = 0; record < records_; record += kPacketsPerCall) {
        char* const p = first + record * stride;
        const std::uint32_t packets = std::min(kPacketsPerCall, records_ - record);
        if (closest) {
          rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(p), width_, packets,
                         stride);
        } else {
          rtcOccludedNM(scene, &context, reinterpret_cast<RTCRayN*>(p), width_, packets, stride);
        }
      }
      break;
  }
}

std::uint32_t EmbreeRays::Primitive(std::uint32_t i, const BenchScene& scene) const {
  const auto geometry = std::bit_cast<std::uint32_t>(Word(kGeometryField, i));
  if (geometry == RTC_INVALID_GEOMETRY_ID) return kNoPrimitive;
  const auto primitive = std::bit_cast<std::uint32_t>(Word(kPrimitiveField, i));
  return geometry == 0 ? primitive : scene.triangle_count() + primitive;
}

FlushDenormals::FlushDenormals() {
#if defined(__x86_64__)
  constexpr std::uint32_t kFlushToZeroAndDenormalsAreZero = 0x8040;
  saved_ = _mm_getcsr();
  _mm_setcsr(saved_ | kFlushToZeroAndDenormalsAreZero);
#endif
}

FlushDenormals::~FlushDenormals() {
#if defined(__x86_64__)
  _mm_setcsr(saved_);
#endif
}

}  // namespace sheaf::bench
