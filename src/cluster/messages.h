// What ranks tell each other. Rank 0 leads; the others speak with it alone, but for the scene,
// which each hands on.
#ifndef SHEAF_CLUSTER_MESSAGES_H_
#define SHEAF_CLUSTER_MESSAGES_H_

#include <optional>
#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/render.h"
#include "sheaf/stats.h"
#include "src/cluster/area_worker.h"

namespace sheaf {

enum MessageKind : int {
  // From rank 0.
  kFilesMessage,  // a piece of the files and the options, handed on from rank to rank
  kFrameMessage,  // a FrameOrder: render with me
  kAreaMessage,   // a PixelRect
  kEndMessage,    // no more areas of this frame
  kStopMessage,   // the work is over, well or not
  // To rank 0.
  kReadyMessage,  // a RankInfo: its scene is compiled
  kRowsMessage,   // a FinishedArea
  kStatsMessage,  // RenderStats: all of its areas are sent
  kErrorMessage,  // an Error
  kByeMessage,    // after kStopMessage: the last
};

// The picture that all ranks are about to render.
struct FrameOrder {
  int camera_index = 0;
  bool has_number = false;
  int number = 0;  // of a sequence
  Layers layers;
};

// What a rank renders with.
struct RankInfo {
  std::string host, target;
  int threads = 0;
};

std::string HostName();
RankInfo RankInfoOf(const RenderOptions& options);  // of this process

// An error of a rank; no kind: memory ran out.
struct RankError {
  std::optional<ErrorKind> kind;
  std::string message;
};

std::string Pack(const RankInfo& info);
std::string Pack(const FinishedArea& area);
std::string Pack(const RenderStats& stats);
std::string Pack(const RankError& error);
RankInfo UnpackInfo(std::string_view bytes);
FinishedArea UnpackArea(std::string_view bytes);
RenderStats UnpackStats(std::string_view bytes);
RankError UnpackError(std::string_view bytes);

// Waits between looks at the messages: the longer the less happens, at most two milliseconds, so
// that waiting takes no core from who renders.
class Patience {
 public:
  void Rest();                  // nothing happened
  void Reset() { rests_ = 0; }  // something did

 private:
  int rests_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_MESSAGES_H_
