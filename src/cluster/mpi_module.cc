// The only file that knows MPI.
#include <mpi.h>

#include <algorithm>
#include <list>
#include <utility>

#include "src/cluster/ranks.h"

namespace sheaf {
namespace {

class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
  }

  int rank() const override { return rank_; }
  int count() const override { return count_; }

  void Send(int to, int kind, std::string bytes) override {
    // The list's nodes, and so the bytes that MPI reads, stay where they are.
    Outgoing& message = outgoing_.emplace_back();
    message.bytes = std::move(bytes);
    MPI_Isend(message.bytes.data(), static_cast<int>(message.bytes.size()), MPI_BYTE, to, kind,
              MPI_COMM_WORLD, &message.request);
  }

  void Drive() override {
    outgoing_.remove_if([](Outgoing& sent) {
      int is_done = 0;
      MPI_Test(&sent.request, &is_done, MPI_STATUS_IGNORE);
      return is_done != 0;
    });
  }

  bool Receive(RankMessage* message) override {
    Drive();
    int is_there = 0;
    MPI_Message handle;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, &handle, &status);
    if (is_there == 0) return false;
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    message->from = status.MPI_SOURCE;
    message->kind = status.MPI_TAG;
    message->bytes.resize(static_cast<std::size_t>(size));
    MPI_Mrecv(message->bytes.data(), size, MPI_BYTE, &handle, MPI_STATUS_IGNORE);
    return true;
  }

  std::size_t pending() const override { return outgoing_.size(); }

  void Leave() override {
    for (Outgoing& sent : outgoing_) MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
    outgoing_.clear();
    MPI_Finalize();
  }

 private:
  struct Outgoing {
    std::string bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  int rank_ = 0, count_ = 1;
  std::list<Outgoing> outgoing_;
};

}  // namespace
}  // namespace sheaf

extern "C" __attribute__((visibility("default"))) sheaf::Ranks* SheafJoinRanks(std::string& error) {
  int given = 0;
  // One thread of each process talks to the others.
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given) != MPI_SUCCESS ||
      given < MPI_THREAD_FUNNELED) {
    error = "MPI cannot be started with threads";
    return nullptr;
  }
  static sheaf::MpiRanks ranks;
  return &ranks;
}
