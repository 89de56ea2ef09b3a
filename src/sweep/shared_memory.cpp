#include "shared_memory.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <system_error>
#include <utility>

namespace clog::sweep {
namespace {

namespace fs = std::filesystem;

constexpr int seals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;

/// Whether an array is complete, and belongs to this user. An array without seals is incomplete, because the
/// process that builds it has not finished.
bool is_complete_and_own(int descriptor) {
  struct stat status;
  const int found = fcntl(descriptor, F_GET_SEALS);
  return found != -1 && (found & seals) == seals && fstat(descriptor, &status) == 0 &&
         status.st_uid == geteuid();
}

bool write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = retried([&] { return write(descriptor, bytes.data(), bytes.size()); });
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

/// Calls visit() for files that processes of this user have open, until visit() returns true. The files are
/// found in /proc.
/// @param link  target of the links in /proc; only files with this target are visited
void visit_open_files(const fs::path& link, const std::function<bool(const fs::path&)>& visit) {
  // An unreadable process belongs to another user, or has just ended.
  std::error_code error;
  for (fs::directory_iterator process("/proc", error); process != fs::directory_iterator();
       process.increment(error)) {
    struct stat status;
    if (!std::isdigit(static_cast<unsigned char>(process->path().filename().native()[0]))) continue;
    if (stat(process->path().c_str(), &status) != 0 || status.st_uid != geteuid()) continue;
    std::error_code no_access;
    for (fs::directory_iterator file(process->path() / "fd", no_access); file != fs::directory_iterator();
         file.increment(no_access)) {
      std::error_code gone;
      if (fs::read_symlink(file->path(), gone) == link && visit(file->path())) return;
    }
  }
}

/// The inode of the socket that is bound to an abstract address; empty if there is no such socket, or if the
/// inode is unknown.
std::string inode_of(const std::string& address) {
  std::ifstream sockets("/proc/net/unix");
  for (std::string line; std::getline(sockets, line);) {
    std::istringstream words(line);
    std::string word, inode, path;
    for (int i = 0; i < 6; ++i) words >> word;
    if (words >> inode >> path && path == '@' + address) return inode;
  }
  return "";
}

}  // namespace

SharedMemory::~SharedMemory() {
  if (bytes_.data()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

std::shared_ptr<const SharedMemory> SharedMemory::map(Descriptor file) {
  struct stat status;
  if (fstat(file, &status) != 0 || status.st_size == 0) return nullptr;
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const begin = mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0);
  if (begin == MAP_FAILED) return nullptr;
  std::shared_ptr<SharedMemory> memory(new SharedMemory(std::move(file)));
  memory->bytes_ = {static_cast<const std::byte*>(begin), size};
  return memory;
}

std::shared_ptr<const SharedMemory> SharedMemory::find(const std::string& name) {
  std::shared_ptr<const SharedMemory> memory;
  visit_open_files("/memfd:" + name + " (deleted)", [&](const fs::path& file) {
    Descriptor found(open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (found.is_open() && is_complete_and_own(found)) memory = map(std::move(found));
    return memory != nullptr;
  });
  return memory;
}

std::shared_ptr<const SharedMemory> SharedMemory::publish(
    const std::string& name, std::span<const std::span<const std::byte>> pieces) {
  Descriptor file(memfd_create(name.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING));
  const bool is_whole =
      file.is_open() && std::ranges::all_of(pieces, [&](auto piece) { return write_all(file, piece); });
  return is_whole && fcntl(file, F_ADD_SEALS, seals) == 0 ? map(std::move(file)) : nullptr;
}

NameLock::NameLock(const std::string& name)
    : address_(fmt::format("clogsweep-{}-{}", geteuid(), std::hash<std::string>{}(name))),
      socket_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (!socket_.is_open()) return;
  // An abstract address, which exists on this machine as long as the socket is open. No process ever connects
  // to the address.
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path + 1, address_.data(), address_.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + address_.size());
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), length) == 0)
    state_ = State::held;
  else if (errno == EADDRINUSE)
    state_ = State::held_by_another;
}

bool NameLock::is_taken_by_another_user() const {
  const std::string inode = inode_of(address_);
  if (inode.empty()) return false;
  bool is_own = false;
  visit_open_files("socket:[" + inode + "]", [&](const fs::path&) { return is_own = true; });
  return !is_own && inode_of(address_) == inode;  // if the inode has changed, the holder has just ended
}

}  // namespace clog::sweep
