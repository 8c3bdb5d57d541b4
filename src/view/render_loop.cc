#include "src/view/render_loop.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include "src/scene/projection.h"

namespace sheaf {
namespace {

// How often a frame at rest shows what it has so far.
constexpr double kPublishSeconds = 0.1;
// Of the time of a picture in motion; the rest is for the window that draws it.
constexpr double kShare = 0.9;
// A draft that takes so many times its budget is stopped where something newer is wanted.
constexpr double kPatience = 3;

// The window's own thread goes first wherever the two want one core, so that drawing a picture
// takes no longer because the next one is rendered. Threads that this one starts are like it.
void StepBack() {
  constexpr int kNice = 5;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), getpriority(PRIO_PROCESS, 0) + kNice);
}

// The same light, developed in another way.
bool DiffersInDevelopmentAlone(const ViewRequest& a, const ViewRequest& b) {
  const auto is_same = [](const Camera& one, const Camera& other) {
    return one.eye == other.eye && one.look_at == other.look_at && one.up == other.up &&
           one.projection.index() == other.projection.index() &&
           ParameterOf(one.projection) == ParameterOf(other.projection);
  };
  return a.scene == b.scene && is_same(a.camera, b.camera) && a.goal == b.goal &&
         a.max_depth == b.max_depth && a.integrator == b.integrator && a.contrast == b.contrast &&
         a.min_throughput == b.min_throughput && a.precision == b.precision &&
         a.target == b.target && a.beside == b.beside && a.shown == b.shown &&
         a.threads == b.threads;
}

// Where the right half begins, between two tiles where there are any.
int MiddleOf(int width, int tile) {
  const int middle = (width / 2 + tile / 2) / tile * tile;
  return middle > 0 && middle < width ? middle : width / 2;
}

}  // namespace

RenderLoop::RenderLoop(double frame_seconds, std::function<void()> wake)
    : wake_(std::move(wake)), plan_(kShare * frame_seconds), thread_([this] { Run(); }) {}

RenderLoop::~RenderLoop() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    if (progress_) progress_->stop = true;
  }
  changed_.notify_all();
  thread_.join();
}

double RenderLoop::Now() const {
  return std::chrono::duration<double>(Clock::now() - origin_).count();
}

// A frame at rest stops at once; a draft only where it is far too slow.
void RenderLoop::StopJob() {
  if (!job_ || !progress_) return;
  if (!job_->is_draft || Now() - job_start_ > kPatience * plan_.budget()) progress_->stop = true;
}

void RenderLoop::Submit(const ViewRequest& request) {
  {
    const std::lock_guard lock(mutex_);
    pending_ = request;
    if (!DiffersInDevelopmentAlone(request, request_)) StopJob();
  }
  changed_.notify_all();
}

void RenderLoop::Post(Task task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    StopJob();
  }
  changed_.notify_all();
}

std::shared_ptr<const ViewPicture> RenderLoop::Latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

std::string RenderLoop::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

void RenderLoop::TakeRequest() {
  const bool renders = !DiffersInDevelopmentAlone(request_, *pending_);
  request_ = *std::move(pending_);
  pending_.reset();
  if (renders) {
    has_failed_ = false;
    plan_.SetGoal(request_.goal, Now());
    plan_.Restart(Now());
  } else if (latest_ && film_.width() > 0) {
    film_.Develop(request_.development);
    Publish(*latest_);
  }
}

void RenderLoop::RunTask(std::unique_lock<std::mutex>& lock) {
  const Task task = std::move(tasks_.front());
  tasks_.pop_front();
  lock.unlock();
  std::string failure;
  try {
    task(film_);
  } catch (const std::bad_alloc&) {
    failure = "not enough memory";
  }
  wake_();
  lock.lock();
  if (!failure.empty()) error_ = failure;
}

void RenderLoop::Run() {
  StepBack();
  std::unique_lock lock(mutex_);
  while (!is_ending_) {
    if (pending_) TakeRequest();
    if (!tasks_.empty()) {
      RunTask(lock);
      continue;
    }
    const bool may_render = request_.scene && !has_failed_;
    const std::optional<FrameJob> job = may_render ? plan_.Next(Now()) : std::nullopt;
    if (job) {
      RunJob(*job, lock);
      continue;
    }
    const double wait = may_render ? plan_.Wait(Now()) : 0;
    if (wait > 0) {
      changed_.wait_for(lock, std::chrono::duration<double>(wait));
    } else {
      changed_.wait(lock);
    }
  }
}

void RenderLoop::RunJob(const FrameJob& job, std::unique_lock<std::mutex>& lock) {
  const ViewRequest request = request_;
  progress_ = std::make_shared<RenderProgress>();
  job_ = job;
  job_start_ = Now();
  // Between two drafts a window that is still drawing may keep this thread waiting. That belongs to
  // the time of a picture; a longer wait is a hand that rests.
  const double wait = job_start_ - draft_end_;
  const double idle = wait < plan_.budget() / 4 ? wait : 0;
  lock.unlock();
  ViewPicture picture;
  picture.job = job;
  Status rendered = Done{};
  try {
    rendered = RenderSides(request, job, &picture);
  } catch (const std::bad_alloc&) {
    rendered = Error{ErrorKind::kUsage, "not enough memory for this picture"};
  }
  lock.lock();
  job_.reset();
  const double seconds = Now() - job_start_;
  if (!rendered) {
    if (rendered.error().kind == ErrorKind::kInterrupted) {
      if (job.is_draft) plan_.GiveUp(seconds, static_cast<double>(progress_->pixels_done.load()));
      return;
    }
    has_failed_ = true;
    error_ = rendered.error().message;
    lock.unlock();
    wake_();
    lock.lock();
    return;
  }
  error_.clear();
  // All but the pixels: the tree, and checks of the scene before it.
  double fixed = seconds;
  for (const SideStats& side : picture.sides) fixed -= side.seconds;
  plan_.Finish(job, seconds + idle, std::max(fixed, 0.0) + idle);
  picture.is_whole = true;
  picture.is_finished = plan_.is_finished() && !pending_;
  picture.seconds = seconds;
  Publish(picture);
  if (job.is_draft) draft_end_ = Now();
}

Status RenderLoop::RenderSides(const ViewRequest& request, const FrameJob& job,
                               ViewPicture* picture) {
  film_.Begin(request, job.width, job.height);
  last_publish_ = Now();
  const PixelRect whole{0, 0, job.width, job.height};
  if (!request.beside || job.width < 2) {
    const Status rendered = RenderSide(request, job, whole, request.target, picture);
    if (!rendered) return rendered;
  } else {
    const int middle = MiddleOf(job.width, RenderOptions().tile_size);
    const PixelRect left{0, 0, middle, job.height}, right{middle, 0, job.width, job.height};
    for (const auto& [rect, target] :
         {std::pair(left, request.target), std::pair(right, *request.beside)}) {
      const Status rendered = RenderSide(request, job, rect, target, picture);
      if (!rendered) return rendered;
    }
  }
  film_.Finish();
  return Done{};
}

Status RenderLoop::RenderSide(const ViewRequest& request, const FrameJob& job,
                              const PixelRect& rect, const Target& target, ViewPicture* picture) {
  RenderOptions options = OptionsOf(request, job);
  options.target = target;
  options.crop = rect;
  RenderStats stats;
  int y = rect.y0;
  const RowSink sink = [&](const Film& rows) -> Status {
    film_.AddRows(rows, rect.x0, y);
    y += rows.height;
    const std::lock_guard lock(mutex_);
    if (job.is_draft || Now() - last_publish_ < kPublishSeconds) return Done{};
    last_publish_ = Now();
    picture->seconds = Now() - job_start_;
    Publish(*picture);
    return Done{};
  };
  if (prepared_ != request.scene) {
    renderer_.reset();
    prepared_ = request.scene;
    renderer_.emplace(*prepared_);
  }
  const Status rendered = renderer_->RenderRows(request.camera, options, sink, &stats, &*progress_);
  if (!rendered) return rendered;
  picture->sides.push_back(
      {stats.target, stats.wall_seconds, stats.compile_seconds, stats.rays.traced()});
  return Done{};
}

// The mutex is held.
void RenderLoop::Publish(const ViewPicture& made) {
  auto picture = std::make_shared<ViewPicture>(made);
  picture->width = film_.width();
  picture->height = film_.height();
  picture->rgb = film_.bytes();
  picture->number = ++published_;
  latest_ = std::move(picture);
  wake_();
}

}  // namespace sheaf
