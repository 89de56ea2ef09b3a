#include "clog/scheduler/communicator.hpp"

#include <fmt/core.h>
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string_view>
#include <thread>

#include "clog/core/tools/error.hpp"

namespace clog::scheduler {
namespace {

/// Variables in which launchers give a process its rank.
constexpr const char* rank_variables[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};

/// Sets variables by which Open MPI treats a rank without a launcher as a single rank. Otherwise Open MPI
/// would start a daemon, which looks for ssh, and the rank would end when somebody kills the daemon. Open MPI
/// would also use a folder that all single ranks of a user share. A rank that starts while another rank ends
/// might then fail.
void stand_alone_without_launcher() {
  for (const char* name : rank_variables)
    if (std::getenv(name)) return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  setenv("HOME", "/", 0);  // Open MPI 5 looks for settings in HOME, and does not start without it
}

/// The length of a message, converted to the type that MPI expects.
int count_of(std::size_t num_bytes) {
  constexpr int most = std::numeric_limits<int>::max();
  if (num_bytes > std::size_t{most})
    throw Error(
        fmt::format("cannot send {} bytes to another rank (MPI takes at most {} at once); give fewer "
                    "obstacles",
                    num_bytes, most));
  return static_cast<int>(num_bytes);
}

}  // namespace

Communicator::Communicator(int& argc, char**& argv) {
  stand_alone_without_launcher();
  int provided = 0;  // not used: another thread publishes the table, but only this thread calls MPI
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

bool Communicator::may_be_rank_0() {
  return std::ranges::all_of(rank_variables, [](const char* name) {
    const char* const rank = std::getenv(name);
    return !rank || std::string_view(rank) == "0";
  });
}

Communicator::~Communicator() { MPI_Finalize(); }

std::string Communicator::library_version() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  std::string version(text, length);
  version.resize(std::min(version.size(), version.find_first_of(",\n")));
  // MPICH writes "MPICH Version:", a tab, and the number.
  const std::string_view label = " Version:\t";
  if (const auto at = version.find(label); at != std::string::npos) version.erase(at + 1, label.size() - 1);
  return version;
}

std::string Communicator::host_name() {
  char text[MPI_MAX_PROCESSOR_NAME];
  int length = 0;
  MPI_Get_processor_name(text, &length);
  return {text, static_cast<std::size_t>(length)};
}

std::string Communicator::broadcast(std::string text) const {
  const int length = broadcast(rank_ == 0 ? count_of(text.size()) : 0);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD);
  return text;
}

int Communicator::broadcast(int number) const {
  MPI_Bcast(&number, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return number;
}

std::vector<std::string> Communicator::gather(const std::string& text) const {
  const int length = count_of(text.size());
  std::vector<int> lengths(size_);
  MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  count_of(std::accumulate(lengths.begin(), lengths.end(), std::size_t{0}));
  std::vector<int> starts(size_);
  std::exclusive_scan(lengths.begin(), lengths.end(), starts.begin(), 0);
  std::string all(starts.back() + lengths.back(), '\0');
  MPI_Gatherv(text.data(), length, MPI_CHAR, all.data(), lengths.data(), starts.data(), MPI_CHAR, 0,
              MPI_COMM_WORLD);
  std::vector<std::string> texts;
  if (rank_ == 0)
    for (int rank = 0; rank < size_; ++rank) texts.push_back(all.substr(starts[rank], lengths[rank]));
  return texts;
}

void Communicator::wait_for_all() const {
  MPI_Request request;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  int all_here = 0;
  MPI_Test(&request, &all_here, MPI_STATUS_IGNORE);
  while (!all_here) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    MPI_Test(&request, &all_here, MPI_STATUS_IGNORE);
  }
}

void Communicator::send(int destination, int tag, std::span<const std::byte> bytes) const {
  MPI_Send(bytes.data(), count_of(bytes.size()), MPI_BYTE, destination, tag, MPI_COMM_WORLD);
}

std::optional<Communicator::Envelope> Communicator::probe(int source, int tag) const {
  int waiting = 0;
  MPI_Status status;
  MPI_Iprobe(source == any ? MPI_ANY_SOURCE : source, tag == any ? MPI_ANY_TAG : tag, MPI_COMM_WORLD,
             &waiting, &status);
  if (!waiting) return std::nullopt;
  int num_bytes = 0;
  MPI_Get_count(&status, MPI_BYTE, &num_bytes);
  return Envelope{status.MPI_SOURCE, status.MPI_TAG, static_cast<std::size_t>(num_bytes)};
}

std::vector<std::byte> Communicator::receive(const Envelope& envelope) const {
  std::vector<std::byte> bytes(envelope.num_bytes);
  MPI_Recv(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, envelope.source, envelope.tag,
           MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return bytes;
}

void Communicator::abort(int exit_code) const {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::_Exit(exit_code);
}

}  // namespace clog::scheduler
