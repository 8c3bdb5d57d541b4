// One picture by many ranks, without MPI: areas, rows in order, and the talk between ranks.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "random_scene.h"
#include "sheaf/formats.h"
#include "sheaf/target.h"
#include "src/cluster/area_plan.h"
#include "src/cluster/follower.h"
#include "src/cluster/lead_frame.h"
#include "src/cluster/leader.h"
#include "src/cluster/share_files.h"
#include "src/cluster/strips.h"
#include "src/cluster/wire.h"
#include "src/render/check_options.h"

namespace sheaf {
namespace {

// Ranks that are threads of this process.
class Mailboxes {
 public:
  explicit Mailboxes(int count) : boxes_(static_cast<std::size_t>(count)) {}
  int count() const { return static_cast<int>(boxes_.size()); }
  void Put(int to, RankMessage message) {
    const std::lock_guard lock(mutex_);
    boxes_[static_cast<std::size_t>(to)].push_back(std::move(message));
  }
  bool Get(int rank, RankMessage* message) {
    const std::lock_guard lock(mutex_);
    auto& box = boxes_[static_cast<std::size_t>(rank)];
    if (box.empty()) return false;
    *message = std::move(box.front());
    box.pop_front();
    return true;
  }

 private:
  std::mutex mutex_;
  std::vector<std::deque<RankMessage>> boxes_;
};

class ThreadRanks : public Ranks {
 public:
  ThreadRanks(Mailboxes& boxes, int rank) : boxes_(boxes), rank_(rank) {}
  int rank() const override { return rank_; }
  int count() const override { return boxes_.count(); }
  void Send(int to, int kind, std::string bytes) override {
    boxes_.Put(to, {rank_, kind, std::move(bytes)});
  }
  void Drive() override {}
  bool Receive(RankMessage* message) override { return boxes_.Get(rank_, message); }
  std::size_t pending() const override { return 0; }
  void Leave() override { has_left_ = true; }
  bool has_left() const { return has_left_; }

 private:
  Mailboxes& boxes_;
  const int rank_;
  bool has_left_ = false;
};

const auto kNeverStop = [] { return false; };

TEST_CASE("areas cover every pixel once, in tiles, large ones first") {
  for (const int ranks : {1, 2, 7, 1000}) {
    for (const PixelRect picture : {PixelRect{0, 0, 640, 480}, PixelRect{13, 5, 1000, 77},
                                    PixelRect{0, 0, 1, 1}, PixelRect{0, 0, 5000, 33}}) {
      CAPTURE(ranks);
      AreaPlan plan(picture, 32, ranks, 1 << 18);
      std::int64_t pixels = 0;
      PixelRect before{picture.x0, picture.y0, picture.x1, picture.y0};
      int top = picture.y0;
      while (const auto area = plan.Next(2)) {
        const bool goes_on = area->y0 == before.y0 && area->x0 == before.x1;
        const bool begins = area->y0 == top && area->x0 == picture.x0 && before.x1 == picture.x1;
        REQUIRE((goes_on || begins));
        REQUIRE((area->x0 - picture.x0) % 32 == 0);
        REQUIRE((area->y0 - picture.y0) % 32 == 0);
        const std::int64_t size = std::int64_t{area->width()} * area->height();
        REQUIRE(size > 0);
        REQUIRE((size <= (1 << 18) || area->height() <= 32));
        pixels += size;
        before = *area;
        top = area->y1;
      }
      CHECK(top == picture.y1);
      CHECK(pixels == std::int64_t{picture.width()} * picture.height());
    }
  }
  // The stated part of a rank's share, and at the end four tiles a thread.
  AreaPlan plan({0, 0, 3200, 3200}, 32, 4, 1 << 24);
  CHECK(plan.Next(1)->width() == 100 * 100 / (4 * kAreaShare) * 32);
  AreaPlan small({0, 0, 3200, 32}, 32, 1, 1 << 24);
  CHECK(small.Next(3)->width() == 12 * 32);
}

TEST_CASE("areas that are left out are not handed out, and all others are") {
  Random random(4);
  const PixelRect picture{7, 3, 407, 250};
  for (int round = 0; round < 20; ++round) {
    std::vector<int> times(400 * 247, 0);
    const auto count = [&](const PixelRect& area) {
      for (int y = area.y0; y < area.y1; ++y) {
        for (int x = area.x0; x < area.x1; ++x) {
          ++times[static_cast<std::size_t>(400 * (y - 3) + x - 7)];
        }
      }
    };
    // As a run of other ranks has left them.
    AreaPlan before(picture, 16, 9, 1 << 20);
    AreaPlan plan(picture, 16, 2, 1 << 20);
    while (const auto area = before.Next(1)) {
      if (random() % 3 == 0) continue;
      plan.LeaveOut(*area);
      count(*area);
    }
    while (const auto area = plan.Next(2)) {
      REQUIRE((area->width() == 400 || area->height() <= 16));
      count(*area);
    }
    CHECK(std::count(times.begin(), times.end(), 1) == 400 * 247);
  }
}

TEST_CASE("rows come from the top in whatever order areas come") {
  const PixelRect picture{10, 20, 110, 120};
  Film whole(100, 100, {});
  for (std::size_t i = 0; i < whole.rgb.size(); ++i) whole.rgb[i] = static_cast<float>(i);
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    AreaPlan plan(picture, 8, 20, 1 << 20);
    std::vector<PixelRect> areas;
    while (const auto area = plan.Next(1)) areas.push_back(*area);
    std::shuffle(areas.begin(), areas.end(), random);
    Strips strips(picture);
    Film::Floats got;
    for (const PixelRect& area : areas) {
      Film film(area.width(), area.height(), {});
      for (int y = 0; y < film.height; ++y) {
        std::copy_n(whole.pixel(area.x0 - 10, area.y0 - 20 + y), 3 * film.width, film.pixel(0, y));
      }
      CHECK(!strips.is_done());
      strips.Add(area, std::move(film));
      while (const auto rows = strips.Take()) {
        got.insert(got.end(), rows->rgb.begin(), rows->rgb.end());
      }
    }
    CHECK(strips.is_done());
    CHECK(got == whole.rgb);
  }
}

TEST_CASE("work of any size reaches every rank, and a frame may overtake it") {
  Mailboxes boxes(6);
  SharedWork work{"options", {{"a", std::string(5 << 20, 'x')}, {"b/c", ""}, {"d", "short"}}};
  std::vector<std::jthread> threads;
  std::vector<bool> is_same(6, false);
  boxes.Put(5, {0, kFrameMessage, "early"});
  std::mutex mutex;
  for (int rank = 1; rank < 6; ++rank) {
    threads.emplace_back([&, rank] {
      ThreadRanks ranks(boxes, rank);
      const auto got = ReceiveWork(ranks, kNeverStop);
      bool same = got && got->options == work.options && got->files.size() == work.files.size();
      for (std::size_t i = 0; same && i < work.files.size(); ++i) {
        same =
            got->files[i].path == work.files[i].path && got->files[i].bytes == work.files[i].bytes;
      }
      const std::lock_guard lock(mutex);
      is_same[static_cast<std::size_t>(rank)] = same && got->early.size() == (rank == 5 ? 1 : 0);
    });
  }
  ThreadRanks first(boxes, 0);
  ShareWork(work, first, kNeverStop);
  for (std::jthread& thread : threads) thread.join();
  CHECK(std::count(is_same.begin(), is_same.end(), true) == 5);
}

// Follows in threads, each rank on a target of its own.
using ChangeFrame = std::function<Result<FollowedFrame>(int, FollowedFrame)>;
std::vector<std::jthread> FollowOnThreads(const Scene& scene, const RenderOptions& options,
                                          Mailboxes& boxes, const ChangeFrame& change) {
  std::vector<std::jthread> threads;
  for (int rank = 1; rank < boxes.count(); ++rank) {
    threads.emplace_back([&, change, rank] {
      std::vector<Target> targets = {Target::Scalar()};
      for (const std::string& name : UsableTargets()) targets.push_back(*Target::Named(name));
      ThreadRanks ranks(boxes, rank);
      const OpenFrame open = [&](const FrameOrder& order) {
        FollowedFrame frame{&scene, &scene.cameras.front(), options};
        frame.options.layers = order.layers;
        frame.options.target = targets[static_cast<std::size_t>(rank) % targets.size()];
        return change(rank, frame);
      };
      Follow(ranks, {}, open, kNeverStop);
    });
  }
  return threads;
}

// What rank 0 has of a picture.
struct Gathered {
  Film film;
  Status status = Done{};
  RenderStats stats;
  std::vector<RankRecord> records;
  bool has_left = false;
};

// Renders as rank 0.
Gathered Lead(const Scene& scene, const RenderOptions& options, ThreadRanks& ranks,
              const RowSink* sink, KeptAreas* kept, RenderProgress* progress) {
  Gathered gathered;
  {
    Leader leader(ranks);
    const PixelRect area = AreaOf(options);
    gathered.film = Film(area.width(), area.height(), options.layers);
    int y = 0;
    const RowSink keep = [&](const Film& rows) {
      std::copy(rows.rgb.begin(), rows.rgb.end(), gathered.film.pixel(0, y));
      for (int i = 0; i < kLayerCount; ++i) {
        const Layer layer = static_cast<Layer>(i);
        if (!rows.has(layer)) continue;
        std::copy(rows.layers[i].begin(), rows.layers[i].end(), gathered.film.at(layer, 0, y));
      }
      y += rows.height;
      return Status(Done{});
    };
    gathered.status =
        leader.RenderRows(scene, scene.cameras.front(), {0, false, 0, options.layers}, options,
                          sink != nullptr ? *sink : keep, kept, &gathered.stats, progress);
    gathered.records = leader.records();
  }
  gathered.has_left = ranks.has_left();
  return gathered;
}

Gathered RenderOnThreads(const Scene& scene, const RenderOptions& options, int count,
                         const ChangeFrame& change, const RowSink* sink = nullptr,
                         KeptAreas* kept = nullptr) {
  Mailboxes boxes(count);
  const std::vector<std::jthread> threads = FollowOnThreads(scene, options, boxes, change);
  ThreadRanks ranks(boxes, 0);
  RenderProgress progress;
  return Lead(scene, options, ranks, sink, kept, &progress);
}

Scene CrystalBall() {
  Result<ReadSceneResult> read = ReadScene(SHEAF_SOURCE_DIR "/scenes/crystal-ball.json");
  REQUIRE(read.ok());
  return std::move(read.value().scene);
}

// Whether colours and layers have the same bits.
bool IsSame(const Film& a, const Film& b) {
  const auto same = [](const Film::Floats& x, const Film::Floats& y) {
    if (x.size() != y.size()) return false;
    return x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
  };
  bool is_same = same(a.rgb, b.rgb);
  for (int i = 0; i < kLayerCount; ++i) is_same = is_same && same(a.layers[i], b.layers[i]);
  return is_same;
}

RenderOptions SmallOptions() {
  RenderOptions options;
  options.width = 150;
  options.height = 111;
  options.samples = 2;
  options.max_depth = 4;
  options.threads = 1;
  options.tile_size = 8;
  options.layers.Add(Layer::kDepth);
  options.layers.Add(Layer::kNormal);
  return options;
}

const auto kUnchanged = [](int, FollowedFrame frame) { return Result<FollowedFrame>(frame); };

TEST_CASE("any number of ranks, on targets of their own, give the bits of one") {
  const Scene scene = CrystalBall();
  for (const bool is_cropped : {false, true}) {
    RenderOptions options = SmallOptions();
    if (is_cropped) options.crop = PixelRect{3, 10, 131, 100};
    RenderStats alone;
    const Result<Film> film = Render(scene, scene.cameras.front(), options, &alone);
    REQUIRE(film.ok());
    for (const int count : {1, 2, 3, 9}) {
      CAPTURE(count);
      const Gathered gathered = RenderOnThreads(scene, options, count, kUnchanged);
      REQUIRE(gathered.status.ok());
      CHECK(gathered.has_left);
      CHECK(IsSame(gathered.film, film.value()));
      CHECK(gathered.stats.rays.traced() == alone.rays.traced());
      std::uint64_t rays = 0;
      for (const RankRecord& record : gathered.records) rays += record.stats.rays.traced();
      CHECK(rays == alone.rays.traced());
      CHECK(gathered.records.size() == static_cast<std::size_t>(count));
    }
  }
}

TEST_CASE("an error of any rank, or of the sink, ends the picture once and for all") {
  const Scene scene = CrystalBall();
  const RenderOptions options = SmallOptions();
  const auto broken = [](int rank, FollowedFrame frame) -> Result<FollowedFrame> {
    if (rank == 2) return Error{ErrorKind::kScene, "s.json:3: broken"};
    return frame;
  };
  const Gathered failed = RenderOnThreads(scene, options, 4, broken);
  REQUIRE(!failed.status.ok());
  CHECK(failed.status.error().kind == ErrorKind::kScene);
  CHECK(failed.status.error().message.starts_with("rank 2 ("));
  CHECK(failed.status.error().message.ends_with("): s.json:3: broken"));
  CHECK(failed.has_left);

  const auto no_memory = [](int rank, FollowedFrame frame) -> Result<FollowedFrame> {
    if (rank == 1) throw std::bad_alloc();
    return frame;
  };
  CHECK_THROWS_AS(RenderOnThreads(scene, options, 3, no_memory), std::bad_alloc);

  const RowSink full = [](const Film&) {
    return Status(Error{ErrorKind::kInputOutput, "a.png: disk full"});
  };
  const Gathered unwritten = RenderOnThreads(scene, options, 3, kUnchanged, &full);
  REQUIRE(!unwritten.status.ok());
  CHECK(unwritten.status.error().message == "a.png: disk full");
  CHECK(unwritten.has_left);
}

// Areas in memory, of this run and of the one before.
class HeldAreas : public KeptAreas {
 public:
  const std::vector<PixelRect>& earlier() const override { return earlier_; }
  Result<Film> Read(std::size_t index) override {
    const PixelRect& area = earlier_[index];
    return films_.at({area.y0, area.x0});
  }
  Status Keep(const PixelRect& area, const Film& pixels) override {
    films_[{area.y0, area.x0}] = pixels;
    areas_[{area.y0, area.x0}] = area;
    pixels_ += std::int64_t{area.width()} * area.height();
    return Done{};
  }
  void BeginNextRun() {
    for (const auto& [at, area] : areas_) earlier_.push_back(area);
  }
  std::int64_t pixels() const { return pixels_; }

 private:
  std::map<std::pair<int, int>, PixelRect> areas_;
  std::map<std::pair<int, int>, Film> films_;
  std::vector<PixelRect> earlier_;
  std::int64_t pixels_ = 0;
};

// Rank 0 where rank 1 dies over its first areas. When all other pixels are kept, the run ends.
class BereavedRank : public ThreadRanks {
 public:
  BereavedRank(Mailboxes& boxes, const HeldAreas& kept, std::int64_t pixels,
               RenderProgress& progress)
      : ThreadRanks(boxes, 0), kept_(kept), pixels_(pixels), progress_(progress) {}
  void Send(int to, int kind, std::string bytes) override {
    if (to == 1 && kind == kAreaMessage) {
      const auto area = WireReader(bytes).Get<PixelRect>();
      lost_pixels += std::int64_t{area.width()} * area.height();
      ++lost_areas;
    }
    ThreadRanks::Send(to, kind, std::move(bytes));
  }
  bool Receive(RankMessage* message) override {
    if (kept_.pixels() + lost_pixels == pixels_) progress_.stop = true;
    return ThreadRanks::Receive(message) && !(message->from == 1 && message->kind == kRowsMessage);
  }

  std::int64_t lost_pixels = 0;
  int lost_areas = 0;

 private:
  const HeldAreas& kept_;
  const std::int64_t pixels_;
  RenderProgress& progress_;
};

TEST_CASE("what all ranks but one had finished is not rendered again") {
  const Scene scene = CrystalBall();
  const RenderOptions options = SmallOptions();
  const Result<Film> film = Render(scene, scene.cameras.front(), options);
  REQUIRE(film.ok());
  const std::int64_t pixels = std::int64_t{options.width} * options.height;
  HeldAreas kept;
  int lost_areas = 0;
  // Again where rank 1 was too late for any area.
  for (int round = 0; round < 100 && lost_areas < kAreasAtOnce; ++round) {
    kept = HeldAreas();
    Mailboxes boxes(3);
    const std::vector<std::jthread> threads = FollowOnThreads(scene, options, boxes, kUnchanged);
    RenderProgress progress;
    BereavedRank ranks(boxes, kept, pixels, progress);
    const Gathered killed = Lead(scene, options, ranks, nullptr, &kept, &progress);
    REQUIRE(!killed.status.ok());
    CHECK(killed.status.error().kind == ErrorKind::kInterrupted);
    CHECK(kept.pixels() + ranks.lost_pixels == pixels);
    lost_areas = ranks.lost_areas;
  }
  REQUIRE(lost_areas == kAreasAtOnce);
  const std::int64_t lost = pixels - kept.pixels();
  kept.BeginNextRun();
  for (const int count : {1, 4}) {
    CAPTURE(count);
    HeldAreas next = kept;
    const Gathered resumed = RenderOnThreads(scene, options, count, kUnchanged, nullptr, &next);
    REQUIRE(resumed.status.ok());
    CHECK(IsSame(resumed.film, film.value()));
    CHECK(resumed.stats.rays.primary == static_cast<std::uint64_t>(options.samples * lost));
    CHECK(next.pixels() == pixels);
  }
}

}  // namespace
}  // namespace sheaf
