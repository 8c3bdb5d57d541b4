#include "src/cluster/share_files.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "src/cluster/messages.h"
#include "src/cluster/wire.h"

namespace sheaf {
namespace {

// Small beside a scene, so that ranks far down the tree begin early; large beside a message's cost.
constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

// Pieces on their way at a time, so that a scene is not in memory once more.
constexpr std::size_t kMostPending = 8;

void HandOn(const std::string& piece, Ranks& ranks) {
  for (int child = 2 * ranks.rank() + 1; child <= 2 * ranks.rank() + 2; ++child) {
    if (child < ranks.count()) ranks.Send(child, kFilesMessage, piece);
  }
}

// Lets messages go out until at most so many are left.
void Flush(std::size_t most, Ranks& ranks, const std::function<bool()>& stop) {
  Patience patience;
  for (ranks.Drive(); ranks.pending() > most && !stop(); ranks.Drive()) patience.Rest();
}

}  // namespace

void ShareWork(const SharedWork& work, Ranks& ranks, const std::function<bool()>& stop) {
  WireWriter writer;
  writer.AddText(work.options);
  writer.Add(static_cast<std::uint64_t>(work.files.size()));
  for (const HeldFile& file : work.files) {
    writer.AddText(file.path);
    writer.AddText(file.bytes);
  }
  const std::string bytes = writer.Take();
  WireWriter size;
  size.Add(static_cast<std::uint64_t>(bytes.size()));
  HandOn(size.Take(), ranks);
  for (std::size_t at = 0; at < bytes.size() && !stop(); at += kPieceBytes) {
    HandOn(bytes.substr(at, kPieceBytes), ranks);
    Flush(kMostPending, ranks, stop);
  }
  Flush(0, ranks, stop);
}

std::optional<SharedWork> ReceiveWork(Ranks& ranks, const std::function<bool()>& stop) {
  std::optional<std::uint64_t> size;
  std::string bytes;
  SharedWork work;
  Patience patience;
  while (!size || bytes.size() < *size) {
    if (stop()) return std::nullopt;
    RankMessage message;
    if (!ranks.Receive(&message)) {
      patience.Rest();
      continue;
    }
    patience.Reset();
    if (message.kind == kStopMessage) return std::nullopt;
    if (message.kind != kFilesMessage) {
      work.early.push_back(std::move(message));
      continue;
    }
    HandOn(message.bytes, ranks);
    Flush(kMostPending, ranks, stop);
    if (!size) {
      size = WireReader(message.bytes).Get<std::uint64_t>();
    } else {
      bytes += message.bytes;
    }
  }
  Flush(0, ranks, stop);
  WireReader reader(bytes);
  work.options = reader.GetText();
  work.files.resize(reader.Get<std::uint64_t>());
  for (HeldFile& file : work.files) {
    file.path = reader.GetText();
    file.bytes = reader.GetText();
  }
  return work;
}

}  // namespace sheaf
