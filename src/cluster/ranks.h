// The processes of one render, and messages between them.
//
// What carries them is a module of its own, libsheaf_mpi.so, which the command loads where it was
// started by mpirun or its like: nothing else needs MPI. The two are built together, so that they
// share types.
#ifndef SHEAF_CLUSTER_RANKS_H_
#define SHEAF_CLUSTER_RANKS_H_

#include <cstddef>
#include <string>

namespace sheaf {

struct RankMessage {
  int from = 0;  // a rank
  int kind = 0;
  std::string bytes;
};

// One thread of a process calls it. Messages from one rank to another arrive in their order.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;   // this process, from 0
  virtual int count() const = 0;  // of processes

  // Never waits: the message goes out while Drive or Receive is called. At most 1 GiB.
  virtual void Send(int to, int kind, std::string bytes) = 0;

  virtual void Drive() = 0;

  // Whether there was a message. Never waits for one.
  virtual bool Receive(RankMessage* message) = 0;

  // How many messages have not gone out yet.
  virtual std::size_t pending() const = 0;

  // All ranks call it as the last thing, or none does: it waits for the others.
  virtual void Leave() = 0;
};

// Null, with one line in `error`, where there are none. Lives as long as the process.
using JoinRanks = Ranks*(std::string& error);
inline constexpr const char* kMpiModule = "libsheaf_mpi.so";
inline constexpr const char* kJoinRanks = "SheafJoinRanks";

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_RANKS_H_
