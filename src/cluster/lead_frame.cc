#include "src/cluster/lead_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <string>
#include <utility>

#include "src/cluster/wire.h"
#include "src/core/parallel.h"
#include "src/core/running_target.h"
#include "src/render/check_options.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kAreaBytes = std::int64_t{16} << 20;
constexpr std::int64_t kLeastWindowBytes = std::int64_t{256} << 20;
// What all ranks have in hand is this part of the window, so that they go on while a slow area
// holds up the rows below it.
constexpr std::int64_t kWindowDepth = 4;
constexpr std::int64_t kMostWindowBytes = std::int64_t{2} << 30;

std::int64_t PixelCount(const PixelRect& area) {
  return std::int64_t{area.width()} * area.height();
}

std::int64_t PixelBytes(const Layers& layers) {
  std::int64_t floats = 3;
  for (int i = 0; i < kLayerCount; ++i) {
    if (layers.has(static_cast<Layer>(i))) floats += kLayerChannels[i];
  }
  return floats * static_cast<std::int64_t>(sizeof(float));
}

LeadLimits PixelLimits(const RenderOptions& options, int ranks) {
  const std::int64_t pixel = PixelBytes(options.layers);
  const std::int64_t tile = pixel * options.tile_size * options.tile_size;
  // The other ranks are not known yet; they are as rank 0 where it matters.
  const LeadLimits limits =
      LimitsFor(ranks, ThreadCount(options.threads), static_cast<double>(tile));
  return {limits.window / pixel, limits.area / pixel};
}

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

LeadLimits LimitsFor(int ranks, int threads, double tile_bytes) {
  const auto all = kWindowDepth * kAreasAtOnce * ranks;
  const double small = tile_bytes * kTilesPerThread * threads * static_cast<double>(all);
  const double window = std::clamp(small, static_cast<double>(kLeastWindowBytes),
                                   static_cast<double>(kMostWindowBytes));
  const auto bytes = static_cast<std::int64_t>(window);
  return {bytes, std::min(kAreaBytes, bytes / all)};
}

FrameLead::FrameLead(const Scene& scene, const Camera& camera, const RenderOptions& options,
                     const RowSink& sink, KeptAreas* kept, Ranks& ranks, RenderProgress& progress)
    : options_(options),
      sink_(sink),
      kept_(kept),
      ranks_(ranks),
      progress_(progress),
      limits_(PixelLimits(options, ranks.count())),
      plan_(AreaOf(options), options.tile_size, ranks.count(), limits_.area),
      strips_(AreaOf(options)),
      has_ended_(static_cast<std::size_t>(ranks.count()), false),
      records_(static_cast<std::size_t>(ranks.count())),
      running_(ranks.count()),
      start_(Clock::now()),
      own_(scene, camera, options) {
  if (kept_ == nullptr) return;
  for (const PixelRect& area : kept_->earlier()) plan_.LeaveOut(area);
}

FrameLead::~FrameLead() {
  if (writing_.valid()) writing_.wait();
}

Status FrameLead::Run(const FrameOrder& order) {
  WireWriter writer;
  writer.Add(order);
  const std::string bytes = writer.Take();
  for (int rank = 1; rank < ranks_.count(); ++rank) ranks_.Send(rank, kFrameMessage, bytes);
  Patience patience;
  while (!IsDone()) {
    if (progress_.stop.load(std::memory_order_relaxed)) {
      Fail({ErrorKind::kInterrupted, "rendering was interrupted"});
    }
    if (error_) return *error_;
    const bool happened[] = {TakeMessage(), TakeOwn(), HandOut(), Write()};
    if (std::count(std::begin(happened), std::end(happened), true) > 0) {
      patience.Reset();
    } else {
      patience.Rest();
    }
  }
  return error_ ? Status(*error_) : Status(Done{});
}

bool FrameLead::IsDone() const { return running_ == 0 && strips_.is_done() && !writing_.valid(); }

void FrameLead::Fail(Error error) {
  if (!error_) error_ = std::move(error);
}

bool FrameLead::TakeMessage() {
  RankMessage message;
  if (!ranks_.Receive(&message)) return false;
  switch (message.kind) {
    case kReadyMessage:
      Welcome(message.from, UnpackInfo(message.bytes));
      break;
    case kRowsMessage:
      Finish(message.from, UnpackArea(message.bytes));
      break;
    case kStatsMessage:
      FinishRank(message.from, UnpackStats(message.bytes));
      break;
    case kErrorMessage: {
      RankError error = UnpackError(message.bytes);
      if (!error.kind) throw std::bad_alloc();
      Fail({*error.kind, std::move(error.message)});
      break;
    }
    default:
      break;
  }
  return true;
}

bool FrameLead::TakeOwn() {
  const RankRecord& record = records_.front();
  if (record.info.threads == 0 && own_.is_ready()) {
    progress_.stage.store(RenderStage::kRendering, std::memory_order_relaxed);
    Welcome(0, RankInfoOf(options_));
    return true;
  }
  if (std::optional<FinishedArea> area = own_.Take()) {
    Finish(0, std::move(*area));
    return true;
  }
  if (is_own_done_ || !own_.is_done()) return false;
  is_own_done_ = true;
  const Status status = own_.Join();
  if (!status) {
    Fail(status.error());
  } else {
    FinishRank(0, own_.stats());
  }
  return true;
}

void FrameLead::Welcome(int rank, RankInfo info) {
  const std::string own = RunningTarget(options_.target);
  if (options_.precision == Precision::kFast && info.target != own) {
    Fail(
        {ErrorKind::kUsage,
         fmt::format("--precision fast: rank {} ({}) runs {} and rank 0 runs {}, whose bits differ",
                     rank, info.host, info.target, own)});
  }
  records_[static_cast<std::size_t>(rank)].info = std::move(info);
  for (int i = 0; i < kAreasAtOnce; ++i) hungry_.push_back(rank);
}

void FrameLead::Finish(int rank, FinishedArea area) {
  progress_.pixels_done.fetch_add(static_cast<std::uint64_t>(PixelCount(area.area)),
                                  std::memory_order_relaxed);
  // On disk before anything else may fail, and before slower rows above it are there.
  if (kept_ != nullptr) {
    if (const Status kept = kept_->Keep(area.area, area.pixels); !kept) Fail(kept.error());
  }
  strips_.Add(area.area, std::move(area.pixels));
  hungry_.push_back(rank);
}

// What earlier runs have left of the rows that are to be written next. It is read no sooner, so
// that nobody holds the picture.
void FrameLead::AddEarlier() {
  while (kept_ != nullptr && next_earlier_ < kept_->earlier().size()) {
    const PixelRect& area = kept_->earlier()[next_earlier_];
    if (area.y0 > strips_.top()) return;
    Result<Film> pixels = kept_->Read(next_earlier_++);
    if (!pixels) return Fail(pixels.error());
    out_pixels_ += PixelCount(area);
    strips_.Add(area, std::move(pixels).value());
  }
}

void FrameLead::FinishRank(int rank, RenderStats stats) {
  records_[static_cast<std::size_t>(rank)].stats = std::move(stats);
  if (--running_ > 0) return;
  const double span = SecondsSince(start_);
  for (RankRecord& record : records_) {
    const double busy = record.stats.compile_seconds + record.stats.wall_seconds;
    record.idle = std::clamp(1 - busy / span, 0.0, 1.0);
  }
}

bool FrameLead::HandOut() {
  if (hungry_.empty() || out_pixels_ >= limits_.window) return false;
  const int rank = hungry_.front();
  hungry_.pop_front();
  const auto at = static_cast<std::size_t>(rank);
  const std::optional<PixelRect> area = plan_.Next(records_[at].info.threads);
  if (!area && has_ended_[at]) return true;
  has_ended_[at] = !area;
  if (area) out_pixels_ += PixelCount(*area);
  if (rank == 0) {
    area ? own_.Give(*area) : own_.End();
    return true;
  }
  WireWriter writer;
  if (area) writer.Add(*area);
  ranks_.Send(rank, area ? kAreaMessage : kEndMessage, writer.Take());
  return true;
}

bool FrameLead::Write() {
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    const Status status = writing_.get();
    if (!status) Fail(status.error());
    out_pixels_ -= static_cast<std::int64_t>(written_.pixel_count());
    return true;
  }
  AddEarlier();
  std::optional<Film> rows = strips_.Take();
  if (!rows) return false;
  written_ = std::move(*rows);
  writing_ = std::async(std::launch::async, [this] { return sink_(written_); });
  return true;
}

RenderStats FrameLead::Total() const {
  RenderStats total = records_.front().stats;
  total.rays = {};
  total.threads = 0;
  total.buffer_bytes = 0;
  for (double& seconds : total.phase_seconds) seconds = 0;
  for (LaneUse& use : total.lane_use) use = {};
  for (const RankRecord& record : records_) {
    const RenderStats& stats = record.stats;
    total.rays += stats.rays;
    total.threads += stats.threads;
    total.buffer_bytes += stats.buffer_bytes;
    total.wall_seconds = std::max(total.wall_seconds, stats.wall_seconds);
    total.compile_seconds = std::max(total.compile_seconds, stats.compile_seconds);
    for (int i = 0; i < static_cast<int>(Phase::kCount); ++i) {
      total.phase_seconds[i] += stats.phase_seconds[i];
      total.lane_use[i] += stats.lane_use[i];
    }
    // Names of different targets, each once.
    if (total.target.find(stats.target) == std::string::npos) total.target += "+" + stats.target;
  }
  return total;
}

}  // namespace sheaf
