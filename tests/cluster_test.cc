// One picture by many ranks, without MPI: areas, rows in order, and the talk between ranks.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "random_scene.h"
#include "sheaf/formats.h"
#include "sheaf/target.h"
#include "src/cluster/area_plan.h"
#include "src/cluster/follower.h"
#include "src/cluster/leader.h"
#include "src/cluster/share_files.h"
#include "src/cluster/strips.h"
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

// Follows in threads, each rank on a target of its own, and renders as rank 0.
struct Gathered {
  Film film;
  Status status = Done{};
  RenderStats stats;
  std::vector<RankRecord> records;
  bool has_left = false;
};
Gathered RenderOnThreads(const Scene& scene, const RenderOptions& options, int count,
                         const std::function<Result<FollowedFrame>(int, FollowedFrame)>& change,
                         const RowSink* sink = nullptr) {
  Mailboxes boxes(count);
  std::vector<Target> targets = {Target::Scalar()};
  for (const std::string& name : UsableTargets()) targets.push_back(*Target::Named(name));
  std::vector<std::jthread> threads;
  for (int rank = 1; rank < count; ++rank) {
    threads.emplace_back([&, rank] {
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
  Gathered gathered;
  ThreadRanks ranks(boxes, 0);
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
    RenderProgress progress;
    gathered.status =
        leader.RenderRows(scene, scene.cameras.front(), {0, false, 0, options.layers}, options,
                          sink != nullptr ? *sink : keep, &gathered.stats, &progress);
    gathered.records = leader.records();
  }
  for (std::jthread& thread : threads) thread.join();
  gathered.has_left = ranks.has_left();
  return gathered;
}

Scene CrystalBall() {
  Result<ReadSceneResult> read = ReadScene(SHEAF_SOURCE_DIR "/scenes/crystal-ball.json");
  REQUIRE(read.ok());
  return std::move(read.value().scene);
}

// Whether colours and layers have the same bits.
bool IsSame(const Film& a, const Film& b) {
  const auto same = [](const Film::Floats& x, const Film::Floats& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
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

}  // namespace
}  // namespace sheaf
