#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace clog::scheduler {

/// MPI for the duration of a program: initialised on construction, finalised on destruction. Without mpirun,
/// the program is a single rank. Ranks send each other short messages of plain bytes, marked by a tag. All
/// ranks must run the same binary on the same kind of machine.
class Communicator {
 public:
  Communicator(int& argc, char**& argv);
  ~Communicator();
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  /// Whether this process may be rank 0, according to the launcher's environment variables, before MPI
  /// starts. True on rank 0, and on every rank without such variables.
  static bool may_be_rank_0();

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Version of the MPI library, one line.
  static std::string library_version();
  static std::string host_name();

  /// Collective: every rank returns rank 0's text or number.
  std::string broadcast(std::string text) const;
  int broadcast(int number) const;
  /// Collective: rank 0 returns every rank's text, in the order of ranks; the other ranks return an empty
  /// list.
  std::vector<std::string> gather(const std::string& text) const;
  /// Collective: returns when all ranks have called it. It sleeps while it waits (MPI's own barrier spins).
  void wait_for_all() const;

  struct Envelope {
    int source;
    int tag;
    std::size_t num_bytes;
  };
  static constexpr int any = -1;
  /// Sends a message, and returns when the bytes may be reused.
  void send(int destination, int tag, std::span<const std::byte> bytes) const;
  /// The envelope of a waiting message; nullopt if no message is waiting. Never blocks.
  std::optional<Envelope> probe(int source, int tag) const;
  /// Receives the message that probe() found.
  std::vector<std::byte> receive(const Envelope& envelope) const;

  /// Ends all ranks at once. Call this after an error that would let the ranks wait for each other for ever.
  [[noreturn]] void abort(int exit_code) const;

 private:
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace clog::scheduler
